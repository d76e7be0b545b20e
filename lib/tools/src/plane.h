// Points and segments in the plane across the axis.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace dismantle::tools {

inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

inline double squared_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d ab = b - a;
  const double length2 = ab.squaredNorm(), t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0;
  return (p - a - t * ab).squaredNorm();
}

inline double point_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::sqrt(squared_to_segment(p, a, b));
}

}  // namespace dismantle::tools
