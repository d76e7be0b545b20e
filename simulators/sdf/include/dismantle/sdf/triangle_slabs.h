/// Cheap lower bounds of the distance from a triangle: they decide which triangles are measured.
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace dismantle::sdf {

/// A point in the layout of TriangleSlabs: each coordinate four times.
struct PointLanes {
  Eigen::Array4f x, y, z;
  explicit PointLanes(const Eigen::Vector3d& p)
      : x(Eigen::Array4f::Constant(static_cast<float>(p.x()))),
        y(Eigen::Array4f::Constant(static_cast<float>(p.y()))),
        z(Eigen::Array4f::Constant(static_cast<float>(p.z()))) {}
};

/// Four slabs (pairs of parallel planes) that contain a triangle: along its normal, along its longest edge, across that
/// edge, and across its second longest edge. The first three form an oriented box, which for an oblique sliver is far
/// smaller than an axis-aligned one. Single precision, one lane per slab: every supported CPU has four lanes, so no
/// dispatch is needed and results are bitwise equal everywhere.
class TriangleSlabs {
 public:
  /// `reach`: bound of the coordinates of corners and query points.
  TriangleSlabs(const Eigen::Vector3d& a, const Eigen::Vector3d& ab, const Eigen::Vector3d& ac, double reach);

  /// Lower bound of the squared distance of the point, up to a relative error of kRelative.
  float squared_distance(const PointLanes& p) const {
    const Eigen::Array4f off = ((x_ * p.x + y_ * p.y + z_ * p.z + offset_).abs() - half_).max(0.0F);
    const Eigen::Array4f squared = off * off;
    return squared[0] + std::max(squared[1] + squared[2], squared[3]);
  }
  static constexpr double kRelative = 1e-6;  ///< rounding of squares and sums in single precision

  /// Threshold: squared_distance() exceeds it only if the triangle is further away than the root of `squared`.
  static float filter(double squared) { return static_cast<float>(squared * (1 + 2 * kRelative)); }

 private:
  Eigen::Array4f x_, y_, z_, offset_, half_;
};

}  // namespace dismantle::sdf
