#include "contact_law.h"

#include <algorithm>

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

}  // namespace

Vec3 bonded_force(const Vec3& moved, Mat3* resistance) {
  if (resistance != nullptr) *resistance = Mat3::Identity();
  return -moved;
}

Vec3 associated_force(const Vec3& moved, const Vec3& normal, double friction, Mat3* resistance) {
  const double press = -moved.dot(normal);
  const Vec3 drag = -moved - press * normal;
  const double length = drag.norm();
  if (press >= 0 && length <= friction * press) return bonded_force(moved, resistance);
  if (friction * length <= -press) {
    if (resistance != nullptr) *resistance = Mat3::Zero();
    return Vec3::Zero();
  }
  const double s = (press + friction * length) / (1 + friction * friction);
  if (friction == 0 || length == 0) {
    if (resistance != nullptr) *resistance = normal * normal.transpose();
    return s * normal;
  }
  const Vec3 t = drag / length, edge = normal + friction * t;
  if (resistance != nullptr) {
    const Mat3 across = Mat3::Identity() - normal * normal.transpose() - t * t.transpose();
    *resistance = edge * edge.transpose() / (1 + friction * friction) + s * friction / length * across;
  }
  return s * edge;
}

Vec3 limited_force(const Vec3& moved, const Vec3& normal, double limit, Mat3* resistance) {
  const double press = -moved.dot(normal);
  const Vec3 drag = -moved - press * normal;
  const double length = drag.norm();
  Vec3 force = Vec3::Zero();
  if (press > 0) force = press * normal;
  if (resistance != nullptr) *resistance = press > 0 ? Mat3(normal * normal.transpose()) : Mat3(Mat3::Zero());
  const auto plane = [&] { return Mat3::Identity() - normal * normal.transpose(); };
  if (length <= limit) {
    if (resistance != nullptr) *resistance += plane();
    return force + drag;
  }
  if (!(limit > 0)) return force;
  const Vec3 t = drag / length;
  if (resistance != nullptr) *resistance += limit / length * (plane() - t * t.transpose());
  return force + limit * t;
}

Vec3 coulomb_force(const Vec3& moved, const Vec3& normal, double friction, Mat3* resistance) {
  const double press = -moved.dot(normal);
  if (press <= 0) {
    if (resistance != nullptr) *resistance = Mat3::Zero();
    return Vec3::Zero();
  }
  const Vec3 force = limited_force(moved, normal, friction * press, resistance);
  const Vec3 drag = -moved - press * normal;
  if (resistance != nullptr && drag.norm() > friction * press)
    *resistance += friction * drag.normalized() * normal.transpose();
  return force;
}

}  // namespace dismantle::statics
