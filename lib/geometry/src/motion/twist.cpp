#include "dismantle/geometry/twist.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

namespace dismantle::geometry {
namespace {

using Vec3 = Eigen::Vector3d;

}  // namespace

Pose moved_along(const Pose& pose, const Twist& twist, const Vec3& center, double duration) {
  const double rate = twist.angular.norm();
  if (rate * std::abs(duration) < 1e-12) return {duration * twist.linear + pose.t, pose.q};
  const Vec3 axis = twist.angular / rate;
  const Vec3 on_axis = center + axis.cross(twist.linear) / rate;
  const Eigen::Quaterniond rotation = rotation_from_vector(duration * twist.angular);
  const Vec3 t = rotation * (pose.t - on_axis) + on_axis + duration * axis.dot(twist.linear) * axis;
  return {t, (rotation * pose.q).normalized()};
}

Twist fitted_twist(const std::vector<Vec3>& points, const std::vector<Vec3>& velocities,
                   const std::vector<double>& weights, const Vec3& center) {
  double all = 0;
  Vec3 middle = Vec3::Zero(), linear = Vec3::Zero();
  for (std::size_t k = 0; k < points.size(); ++k) {
    all += weights[k];
    middle += weights[k] * points[k];
    linear += weights[k] * velocities[k];
  }
  middle /= all;
  linear /= all;
  // About the centroid of the points, translation and rotation are independent.
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  Vec3 torque = Vec3::Zero();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3 arm = points[k] - middle;
    moments += weights[k] * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
    torque += weights[k] * arm.cross(velocities[k]);
  }
  Twist twist;
  const double damping = 1e-3 * moments.trace();  // points on a line do not determine the rotation about it
  if (damping > 0) twist.angular = (moments + damping * Eigen::Matrix3d::Identity()).ldlt().solve(torque);
  twist.linear = linear + twist.angular.cross(center - middle);
  return twist;
}

}  // namespace dismantle::geometry
