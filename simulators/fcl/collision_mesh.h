/// Wrapper of FCL: the source of this header is the only unit that includes FCL.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "dismantle/mesh.h"
#include "dismantle/pose.h"

namespace dismantle::mesh_collision {

/// Bounding-volume hierarchy (OBBRSS) over triangles. Immutable; safe to share between threads.
class CollisionMesh {
 public:
  /// @throws std::invalid_argument for a mesh without triangles.
  CollisionMesh(const std::vector<Eigen::Vector3d>& vertices, const std::vector<Triangle>& triangles);
  ~CollisionMesh();
  CollisionMesh(CollisionMesh&&) noexcept;
  CollisionMesh& operator=(CollisionMesh&&) noexcept;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

struct TrianglePair {
  std::uint32_t a = 0, b = 0;  ///< triangle indices
};

/// Queries; keeps FCL's buffers, so that repeated calls allocate nothing. One per thread. Only surfaces count: a mesh
/// wholly inside another one does not meet it. Touching counts as meeting.
class Collider {
 public:
  Collider();
  ~Collider();
  /// Do the surfaces meet? Poses place the meshes in one frame.
  bool meet(const CollisionMesh& a, const Pose& pose_a, const CollisionMesh& b, const Pose& pose_b);
  /// All pairs of triangles that meet, at most `limit`; replaces the content of `out`.
  void pairs(const CollisionMesh& a, const Pose& pose_a, const CollisionMesh& b, const Pose& pose_b, std::size_t limit,
             std::vector<TrianglePair>& out);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dismantle::mesh_collision
