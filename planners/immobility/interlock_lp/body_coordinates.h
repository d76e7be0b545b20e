/// Poses of several bodies, and of one as seen from another, to first order and with a bound of the rest.
#pragma once

#include <Eigen/Core>

#include "dismantle/immobility/linear_bound.h"

namespace dismantle::immobility {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// The most that the components of u x v are, up to sign; the arguments likewise.
Eigen::Vector3d cross_most(const Eigen::Vector3d& u, const Eigen::Vector3d& v);

/// Six coordinates of a body's pose: a rotation vector, about a centre of its own, and a shift of that centre. All 0
/// when assembled. This is the most that each of them is, up to sign.
struct BodyReach {
  Vector6 most = Vector6::Zero();
  bool small() const { return most.head<3>().norm() <= 0.25; }  // rad
};

/// The coordinates of body a's pose seen from body b, about a's centre, are of_a x_a + of_b x_b, and differ from that
/// by no more than `rest`.
struct SeenFrom {
  Matrix6 of_a, of_b;
  Vector6 rest = Vector6::Zero();
};

/// `center_b_to_a`: assembled. Both bodies turn by small() angles; `seen`: what is known of the most that the
/// coordinates seen from b are.
///
/// With rotation vectors u, v of a and b, log(exp(-v) exp(u)) = u - v + (u x v) / 2 + rest, |rest| <= (|u| + |v|)^3 / 2
/// while |u| + |v| <= 1/2: integrate d/dr log(exp(-r v) exp(r u)) from 0 to 1, with inverse(right Jacobian of w) =
/// 1 + [w] / 2 + rest, |rest| <= |w|^2 / 10. The shift s seen from b obeys exp(v) s = w, where w is how far a's centre
/// has come from where b took it.
SeenFrom seen_from(const BodyReach& a, const BodyReach& b, const Eigen::Vector3d& center_b_to_a, const Vector6& seen);

}  // namespace dismantle::immobility
