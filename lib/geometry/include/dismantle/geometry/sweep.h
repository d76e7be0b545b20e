/// A triangle swept along a straight line, against the triangles of a solid.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::geometry {

/// Corners of a triangle.
using Corners = std::array<Eigen::Vector3d, 3>;

/// Result of a sweep test.
enum class SweepResult {
  far,      ///< clear, and disjoint from the root box of the hierarchy
  clear,    ///< certainly meets no triangle
  unclear,  ///< may meet a triangle
};

/// Beyond it is where normal * x > at.
struct Plane {
  Eigen::Vector3d normal;  ///< unit
  double at = 0;
};

/// Convex hull of a triangle at two places, grown by a margin. Tests are one-sided: a clear result proves a distance
/// above the margin; an unclear one proves nothing.
class Sweep {
 public:
  Sweep(const Corners& begin, const Corners& end, double margin);
  SweepResult test(const TriangleBvh& bvh) const;
  /// A point of the grown hull beyond the plane, if there is any.
  std::optional<Eigen::Vector3d> beyond(const Plane& plane) const;
  /// True if the part of the grown hull beyond the plane certainly meets no triangle.
  bool clear_beyond(const TriangleBvh& bvh, const Plane& plane) const;

 private:
  struct Axis {
    Eigen::Vector3d n, size;  // size: absolute values of n
    double lo, hi;            // extent of the grown hull along n
  };
  void add_axis(const Eigen::Vector3d& n);
  /// True if n separates the triangle from the grown hull.
  bool apart_along(const Eigen::Vector3d& n, const Corners& triangle) const;
  bool apart(const Corners& triangle) const;
  bool misses(const Aabb& box) const;

  std::array<Eigen::Vector3d, 6> hull_;
  double margin_;
  bool turning_ = false;  // the two triangles are not translates of each other
  bool moving_ = false;   // their centers differ by more than rounding
  Eigen::Vector3d motion_;
  std::array<Eigen::Vector3d, 3> edges_;
  Aabb box_;
  std::array<Axis, 6> axes_;  // one or two normals, three sides, one across
  int axis_count_ = 0;
};

}  // namespace dismantle::geometry
