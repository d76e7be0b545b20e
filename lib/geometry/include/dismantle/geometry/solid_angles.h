#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace dismantle {

/// Sum of the solid angles of triangles seen from the origin (Van Oosterom and Strackee 1983); > 0: from behind. Half
/// angles are added as a product of complex numbers: one arc tangent for all.
class SolidAngles {
 public:
  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    const double y = a.dot(b.cross(c)), x = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    const double next_x = x_ * x - y_ * y, next_y = x_ * y + y_ * x + 0.0, size = std::abs(next_x) + std::abs(next_y);
    if (!(size > 0)) return;  // the origin is a corner
    if (y_ >= 0 && y >= 0 && next_y < 0) ++revolutions_;
    if (y_ < 0 && y < 0 && next_y >= 0) --revolutions_;
    x_ = next_x / size;
    y_ = next_y / size;
  }
  double sum() const { return 2 * (std::atan2(y_, x_) + 2 * std::numbers::pi * revolutions_); }

 private:
  double x_ = 1, y_ = 0;  ///< direction of the sum of half angles
  int revolutions_ = 0;   ///< of it
};

}  // namespace dismantle
