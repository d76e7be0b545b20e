/// Instantaneous rigid motions, and poses that result from them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/pose.h"

namespace dismantle::geometry {

/// Velocity of a reference point of the body, which each function states, and angular velocity (rad) about it.
struct Twist {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
};

/// Moves `pose` for the time `duration` along the screw motion of `twist` with the reference point `center`; all in
/// world axes.
DISMANTLE_API Pose moved_along(const Pose& pose, const Twist& twist, const Eigen::Vector3d& center, double duration);

/// Weighted least squares fit of a twist about `center` to the given velocities of points; `weights` >= 0, at least one
/// positive. Rotations that hardly move any point are damped, so that points on a line do not make the body spin about
/// that line.
DISMANTLE_API Twist fitted_twist(const std::vector<Eigen::Vector3d>& points,
                                 const std::vector<Eigen::Vector3d>& velocities, const std::vector<double>& weights,
                                 const Eigen::Vector3d& center);

}  // namespace dismantle::geometry
