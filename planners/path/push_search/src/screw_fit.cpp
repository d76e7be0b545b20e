#include "dismantle/push_search/screw_fit.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace dismantle::push {
namespace {

/// If the sine of half the rotation angle is smaller, the rotation does not determine its axis.
constexpr double kTellsAxis = 0.3;

}  // namespace

geometry::Twist fitted_screw(const geometry::Twist& rough, const Pose& from, const Pose& to,
                             const Eigen::Vector3d& local_center, double radius, double turned) {
  const Eigen::Vector3d was = from * local_center, is = to * local_center;
  geometry::Twist fit;
  if (turned < 1e-3) {
    fit.linear = (is - was).normalized();
    return fit;
  }
  Eigen::Vector3d axis = rough.angular.normalized();
  Eigen::Vector3d on_axis = is + axis.cross(rough.linear) / rough.angular.norm();
  Eigen::Quaterniond q = to.q * from.q.conjugate();
  double half = std::atan2(q.vec().norm(), q.w());  // in [0, pi]
  Eigen::Vector3d about = q.vec().norm() > 1e-9 ? Eigen::Vector3d(q.vec().normalized()) : axis;
  if (about.dot(axis) < 0) about = -about, half = -half;
  const double angle = 2 * half + 2 * std::numbers::pi * std::round((turned - 2 * half) / (2 * std::numbers::pi));
  if (std::abs(std::sin(half)) > kTellsAxis && about.dot(axis) > 0.9) {
    axis = about;
    const Eigen::Vector3d displacement = is - was, across = displacement - axis * axis.dot(displacement);
    on_axis = 0.5 * (was + is) + 0.5 / std::tan(half) * axis.cross(across);
  }
  const double pitch = axis.dot(is - was) / angle;
  fit.angular = axis;
  fit.linear = axis.cross(is - on_axis) + pitch * axis;
  const double size = fit.linear.norm() + radius;
  fit.linear /= size;
  fit.angular /= size;
  return fit;
}

}  // namespace dismantle::push
