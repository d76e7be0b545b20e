#pragma once

#include <Eigen/Core>

namespace dismantle {

/// Twice the signed area of the triangle (0, a, b).
inline double cross2(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace dismantle
