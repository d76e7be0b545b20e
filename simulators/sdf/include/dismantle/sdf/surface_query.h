/// Exact signed distance to a solid: what the grid is built from, and what contact uses near the surface.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "dismantle/sdf/solid.h"

namespace dismantle::sdf {

constexpr std::uint32_t kNoTriangle = 0xffffffffu;

/// Signed distance with its gradient: `value` < 0 inside; `normal` unit, out of the solid.
struct Sample {
  double value = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  std::uint32_t triangle = kNoTriangle;  ///< closest triangle; kNoTriangle: nothing within the limit
};

/// Bounding-volume hierarchy with precomputed triangles. Immutable; queries allocate nothing.
class SurfaceQuery {
 public:
  explicit SurfaceQuery(const Solid& solid);

  /// Exact signed distance if its magnitude is below `limit`, else a Sample without triangle.
  /// `hint`: a triangle that is probably close (from the last query of a moving point); only affects speed.
  Sample sample(const Eigen::Vector3d& p, double limit = std::numeric_limits<double>::infinity(),
                std::uint32_t hint = kNoTriangle) const;

  std::size_t triangle_count() const { return corners_.size(); }

 private:
  struct Node {
    float lo[3], hi[3];
    std::uint32_t first;  ///< leaf: first slot; inner: right child (left is the next node)
    std::uint32_t count;  ///< 0 = inner
  };
  struct Corner {
    Eigen::Vector3d a, ab, ac;
  };
  void build(std::uint32_t first, std::uint32_t count, std::vector<std::uint32_t>& ids, const std::vector<Aabb>& boxes);
  Sample signed_sample(const Eigen::Vector3d& p, std::uint32_t slot) const;

  std::vector<Node> nodes_;
  std::vector<Corner> corners_;            // by slot: leaves are contiguous
  std::vector<std::uint32_t> triangle_;    // slot -> triangle
  std::vector<std::uint32_t> slot_;        // triangle -> slot
  std::vector<Triangle> indices_;          // by triangle
  std::vector<Eigen::Vector3d> face_, vertex_;
  std::vector<std::array<Eigen::Vector3d, 3>> edge_;
};

}  // namespace dismantle::sdf
