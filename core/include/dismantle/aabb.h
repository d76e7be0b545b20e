/// Axis-aligned boxes.
#pragma once

#include <Eigen/Core>
#include <limits>

namespace dismantle {

/// Axis-aligned box; empty (`lo` above `hi`) until it is extended.
struct Aabb {
  Eigen::Vector3d lo = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d hi = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());

  bool empty() const { return !(lo.array() <= hi.array()).all(); }
  void extend(const Eigen::Vector3d& p) {
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  }
  void extend(const Aabb& b) {
    lo = lo.cwiseMin(b.lo);
    hi = hi.cwiseMax(b.hi);
  }
  void inflate(double r) {
    lo.array() -= r;
    hi.array() += r;
  }
  Eigen::Vector3d center() const { return 0.5 * (lo + hi); }
  Eigen::Vector3d size() const { return hi - lo; }
  bool overlaps(const Aabb& b) const {
    return (lo.array() <= b.hi.array()).all() && (b.lo.array() <= hi.array()).all();
  }
  bool contains(const Eigen::Vector3d& p) const {
    return (lo.array() <= p.array()).all() && (p.array() <= hi.array()).all();
  }
  /// Squared distance from p to the box, 0 inside.
  double squared_distance(const Eigen::Vector3d& p) const {
    return (lo - p).cwiseMax(p - hi).cwiseMax(0.0).squaredNorm();
  }
};

}  // namespace dismantle
