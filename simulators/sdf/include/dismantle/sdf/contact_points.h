/// Where a part can touch another: sample points on its surface, grouped for culling.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "dismantle/geometry/mesh.h"

namespace dismantle::sdf {

struct PointBlock {
  std::uint32_t first = 0, count = 0;  ///< range in ContactPoints::points
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

struct ContactPoints {
  std::vector<Eigen::Vector3d> points;  ///< block by block
  std::vector<PointBlock> blocks;       ///< at most kBlockSize points each
  static constexpr std::uint32_t kBlockSize = 16;
};

struct ContactPointOptions {
  double edge_spacing = 0.1;   ///< along convex edges, assembly units, > 0
  double sharp_angle = 0.26;   ///< rad; edges that bend less count as smooth and get the vertices only
  std::size_t max_points = 60'000;
};

/// Vertices of `surface` (the subdivided mesh) plus samples along the convex sharp edges of `mesh`. Two
/// polyhedra that penetrate have an edge of one going through a face of the other, so edges and vertices
/// of both sides together see every contact down to the spacing; concave edges cannot touch first.
ContactPoints sample_contact_points(const Mesh& mesh, const Mesh& surface, const ContactPointOptions& options);

/// Reorders `points` into blocks.
ContactPoints make_blocks(std::vector<Eigen::Vector3d> points);

}  // namespace dismantle::sdf
