#include "dismantle/pose.h"

#include <algorithm>
#include <cmath>

namespace dismantle {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& w) {
  Eigen::Matrix3d m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

/// V(w) of the exponential map of SE(3): the displacement of the origin under the unit-time twist (v, w) is V(w) v.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& w) {
  const double a2 = w.squaredNorm();
  double b, c;      // (1 - cos a) / a^2 and (a - sin a) / a^3
  if (a2 < 1e-4) {  // series: the closed forms cancel
    b = 0.5 - a2 / 24 * (1 - a2 / 30);
    c = 1.0 / 6 - a2 / 120 * (1 - a2 / 42);
  } else {
    const double a = std::sqrt(a2);
    b = (1 - std::cos(a)) / a2;
    c = (a - std::sin(a)) / (a2 * a);
  }
  const Eigen::Matrix3d k = cross_matrix(w);
  return Eigen::Matrix3d::Identity() + b * k + c * k * k;
}

Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& w) {
  const double a2 = w.squaredNorm();
  double c;  // 1 / a^2 - cot(a / 2) / (2 a)
  if (a2 < 1e-4) {
    c = 1.0 / 12 + a2 / 720 * (1 + a2 / 42);
  } else {
    const double a = std::sqrt(a2);
    c = 1 / a2 - std::cos(0.5 * a) / (2 * a * std::sin(0.5 * a));
  }
  const Eigen::Matrix3d k = cross_matrix(w);
  return Eigen::Matrix3d::Identity() - 0.5 * k + c * k * k;
}

/// Twist about the part's origin at pose `a`; this stays accurate far from the world origin.
struct Twist {
  Eigen::Vector3d w, v;
};

Twist twist_between(const Pose& a, const Pose& b) {
  const Eigen::Vector3d w = rotation_vector(b.q * a.q.conjugate());
  return {w, left_jacobian_inverse(w) * (b.t - a.t)};
}

}  // namespace

double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::Quaterniond d = a.conjugate() * b;
  return 2 * std::atan2(d.vec().norm(), std::abs(d.w()));
}

Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q) {
  const double s = q.vec().norm();
  if (s == 0) return Eigen::Vector3d::Zero();
  const double angle = 2 * std::atan2(s, std::abs(q.w()));
  return q.vec() * ((q.w() < 0 ? -angle : angle) / s);
}

Eigen::Quaterniond rotation_from_vector(const Eigen::Vector3d& w) {
  const double a = w.norm();
  const double k = a < 1e-8 ? 0.5 : std::sin(0.5 * a) / a;
  Eigen::Quaterniond q(std::cos(0.5 * a), k * w.x(), k * w.y(), k * w.z());
  q.normalize();
  return q;
}

Pose screw_interpolate(const Pose& a, const Pose& b, double u) {
  if (u <= 0) return a;
  if (u >= 1) return b;
  const Twist s = twist_between(a, b);
  const Eigen::Vector3d w = u * s.w;
  return {a.t + left_jacobian(w) * (u * s.v), (rotation_from_vector(w) * a.q).normalized()};
}

double screw_travel(const Pose& a, const Pose& b, const Eigen::Vector3d& center, double radius) {
  // On a screw every point keeps its speed |v + w x r|; r is taken at the start.
  const Twist s = twist_between(a, b);
  const double center_travel = (s.v + s.w.cross(a.q * center)).norm();
  return (center_travel + s.w.norm() * radius) * (1 + 1e-12);
}

}  // namespace dismantle
