/// Rigid displacements and the screw motion that joins two of them.
#pragma once

#include <Eigen/Geometry>

#include "dismantle/export.h"

namespace dismantle {

/// x' = q x + t: maps a point of a part from its assembled to its current position.
/// q is a unit quaternion; the identity is the assembled pose.
struct Pose {
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();

  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return q * p + t; }
  /// First b, then this.
  Pose operator*(const Pose& b) const { return {q * b.t + t, (q * b.q).normalized()}; }
  Pose inverse() const {
    const Eigen::Quaterniond i = q.conjugate();
    return {-(i * t), i};
  }
  /// Exact; q and -q differ.
  bool operator==(const Pose& b) const { return t == b.t && q.coeffs() == b.q.coeffs(); }
  bool is_identity(double tolerance = 0.0) const {
    return t.cwiseAbs().maxCoeff() <= tolerance && q.vec().cwiseAbs().maxCoeff() <= tolerance;
  }
};

/// Geodesic angle between two rotations in [0, pi] (section 4.2).
DISMANTLE_API double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

/// Rotation vector (axis times angle in [0, pi]) of q.
DISMANTLE_API Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q);
/// The rotation about `w` by its length in radians; inverse of rotation_vector().
DISMANTLE_API Eigen::Quaterniond rotation_from_vector(const Eigen::Vector3d& w);

/// Pose at u in [0, 1] on the constant screw motion from a (u = 0) to b (u = 1), by the shorter turn.
/// This is the motion that docs/plan-format.md prescribes between two poses of a plan.
DISMANTLE_API Pose screw_interpolate(const Pose& a, const Pose& b, double u);

/// Upper bound of the distance that any point within `radius` of `center` (a point of the part, assembled frame)
/// travels on the screw motion from a to b.
DISMANTLE_API double screw_travel(const Pose& a, const Pose& b, const Eigen::Vector3d& center, double radius);

}  // namespace dismantle
