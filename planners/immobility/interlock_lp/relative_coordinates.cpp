#include "interlock_lp/relative_coordinates.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

}  // namespace

Vec3 abs_cross_bound(const Vec3& u, const Vec3& v) {
  return {u.y() * v.z() + u.z() * v.y(), u.z() * v.x() + u.x() * v.z(), u.x() * v.y() + u.y() * v.x()};
}

RelativeCoordinates relative_coordinates(const CoordinateBound& a, const CoordinateBound& b, const Vec3& center_b_to_a,
                                         const Vector6& relative) {
  const Vec3 turn_a = a.most.head<3>(), turn_b = b.most.head<3>(), shift = relative.tail<3>();
  const Vec3 arm = center_b_to_a.cwiseAbs();
  const double sum = turn_a.norm() + turn_b.norm(), angle = turn_b.norm();
  RelativeCoordinates s;
  s.of_a.setIdentity();
  s.of_b = -Matrix6::Identity();
  // -v x arm, by components of v
  const Vec3& r = center_b_to_a;
  s.of_b.block<3, 3>(3, 0) << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  s.rest.head<3>() = 0.5 * abs_cross_bound(turn_a, turn_b);
  if (angle > 0 && turn_a.norm() > 0) s.rest.head<3>().array() += 0.5 * sum * sum * sum;
  s.rest.tail<3>() = 0.5 * abs_cross_bound(turn_b, abs_cross_bound(turn_b, arm)) + abs_cross_bound(turn_b, shift);
  s.rest.tail<3>().array() += angle * angle * angle / 6 * arm.norm() + 0.5 * angle * angle * shift.norm();
  return s;
}

}  // namespace dismantle::immobility
