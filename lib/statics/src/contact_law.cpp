#include "contact_law.h"

#include <algorithm>

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

}  // namespace

PointForce bonded_force(const Vec3& moved) { return {-moved, Mat3::Identity(), 0.5 * moved.squaredNorm()}; }

PointForce associated_force(const Vec3& moved, const Vec3& normal, double friction) {
  const double press = -moved.dot(normal);
  const Vec3 drag = -moved - press * normal;
  const double length = drag.norm();
  if (length <= friction * press) return bonded_force(moved);
  if (friction * length <= -press) return {Vec3::Zero(), Mat3::Zero(), 0};
  const double s = (press + friction * length) / (1 + friction * friction);
  if (friction == 0 || length == 0) return {s * normal, normal * normal.transpose(), 0.5 * s * s};
  const Vec3 t = drag / length;
  const Vec3 edge = normal + friction * t;
  const Mat3 across = Mat3::Identity() - normal * normal.transpose() - t * t.transpose();
  return {s * edge, edge * edge.transpose() / (1 + friction * friction) + s * friction / length * across,
          0.5 * s * s * (1 + friction * friction)};
}

PointForce limited_force(const Vec3& moved, const Vec3& normal, double limit) {
  const double press = -moved.dot(normal);
  const Vec3 drag = -moved - press * normal;
  const double length = drag.norm();
  PointForce f{Vec3::Zero(), Mat3::Zero(), 0};
  if (press > 0) f = {press * normal, normal * normal.transpose(), 0.5 * press * press};
  const Mat3 plane = Mat3::Identity() - normal * normal.transpose();
  if (length <= limit) {
    f.force += drag;
    f.resistance += plane;
    f.energy += 0.5 * length * length;
  } else if (limit > 0) {
    const Vec3 t = drag / length;
    f.force += limit * t;
    f.resistance += limit / length * (plane - t * t.transpose());
    f.energy += limit * (length - 0.5 * limit);
  }
  return f;
}

PointForce coulomb_force(const Vec3& moved, const Vec3& normal, double friction) {
  const double press = -moved.dot(normal);
  if (press <= 0) return {Vec3::Zero(), Mat3::Zero(), 0};
  PointForce f = limited_force(moved, normal, friction * press);
  const Vec3 drag = -moved - press * normal;
  if (drag.norm() > friction * press) f.resistance += friction * drag.normalized() * normal.transpose();
  return f;
}

}  // namespace dismantle::statics
