/// Bounds of the distance from a triangle that cost a few operations: what decides which triangles are measured.
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace dismantle::sdf {

/// A point as TriangleSlabs reads it: each coordinate four times.
struct PointLanes {
  Eigen::Array4f x, y, z;
  explicit PointLanes(const Eigen::Vector3d& p)
      : x(Eigen::Array4f::Constant(static_cast<float>(p.x()))),
        y(Eigen::Array4f::Constant(static_cast<float>(p.y()))),
        z(Eigen::Array4f::Constant(static_cast<float>(p.z()))) {}
};

/// The space between four pairs of parallel planes that a triangle lies in: its own plane; along its longest edge;
/// across that; and across its second longest edge. The first three make its smallest box, which for a sliver that lies
/// slanted is far smaller than one along the axes. Single precision, one lane for each pair: four lanes are what the
/// baseline of the machine has, so that there is nothing to dispatch and the bits are the same everywhere.
class TriangleSlabs {
 public:
  /// `reach`: no coordinate of a point that is asked for is further from the origin than this, nor is any corner.
  TriangleSlabs(const Eigen::Vector3d& a, const Eigen::Vector3d& ab, const Eigen::Vector3d& ac, double reach);

  /// Not above the squared distance of the point by more than kRelative of it.
  float squared_distance(const PointLanes& p) const {
    const Eigen::Array4f off = ((x_ * p.x + y_ * p.y + z_ * p.z + offset_).abs() - half_).max(0.0F);
    const Eigen::Array4f squared = off * off;
    return squared[0] + std::max(squared[1] + squared[2], squared[3]);
  }
  static constexpr double kRelative = 1e-6;  ///< roundings of squares and sums to single precision

  /// What squared_distance() exceeds only if the triangle is further away than the root of `squared`.
  static float filter(double squared) { return static_cast<float>(squared * (1 + 2 * kRelative)); }

 private:
  Eigen::Array4f x_, y_, z_, offset_, half_;
};

}  // namespace dismantle::sdf
