/// The pose of one body relative to another as a linear form in the poses of both, with a bound of the remainder.
#pragma once

#include <Eigen/Core>

#include "dismantle/immobility/linear_bound.h"

namespace dismantle::immobility {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Bounds of |u x v| by component, for vectors u, v that are themselves bounded by component.
Eigen::Vector3d abs_cross_bound(const Eigen::Vector3d& u, const Eigen::Vector3d& v);

/// A bound of the absolute values of a body's six coordinates: a rotation vector, about a centre of its own, and a
/// shift of that centre. All are 0 when assembled.
struct CoordinateBound {
  Vector6 most = Vector6::Zero();
  /// True where the expansion below is valid for two such bounds: |u| + |v| <= 1/2.
  bool small() const { return most.head<3>().norm() <= 0.25; }  // rad
};

/// The coordinates of body a's pose relative to body b, about a's centre, differ from of_a x_a + of_b x_b by no more
/// than `rest`.
struct RelativeCoordinates {
  Matrix6 of_a, of_b;
  Vector6 rest = Vector6::Zero();
};

/// `center_b_to_a`: assembled. Both bounds are small(). `relative`: a bound of the absolute values of the relative
/// coordinates.
///
/// With rotation vectors u, v of a and b, log(exp(-v) exp(u)) = u - v + (u x v) / 2 + rest, |rest| <= (|u| + |v|)^3 / 2
/// while |u| + |v| <= 1/2: integrate d/dr log(exp(-r v) exp(r u)) from 0 to 1, with inverse(right Jacobian of w) = 1 +
/// [w] / 2 + rest, |rest| <= |w|^2 / 10. The relative shift s satisfies exp(v) s = w, where w leads from the place to
/// which b has carried a's centre to that centre.
RelativeCoordinates relative_coordinates(const CoordinateBound& a, const CoordinateBound& b,
                                         const Eigen::Vector3d& center_b_to_a, const Vector6& relative);

}  // namespace dismantle::immobility
