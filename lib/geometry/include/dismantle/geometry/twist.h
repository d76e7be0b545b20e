/// Instantaneous rigid motions, and where a body is after following one.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/pose.h"

namespace dismantle::geometry {

/// The velocity of a point of the body, which goes with each use, and the angular velocity (rad) about it.
struct Twist {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
};

/// Where `pose` is after the time `duration` on the screw motion of `twist`, whose point is `center`; all in world
/// axes.
DISMANTLE_API Pose moved_along(const Pose& pose, const Twist& twist, const Eigen::Vector3d& center, double duration);

/// The twist about `center` that comes nearest to giving each of the points the velocity that is wanted for it: least
/// squares with `weights` (>= 0, at least one positive). Rotations that hardly move any of the points are damped, so
/// that points on a line do not make the body spin about that line.
DISMANTLE_API Twist fitted_twist(const std::vector<Eigen::Vector3d>& points,
                                 const std::vector<Eigen::Vector3d>& velocities, const std::vector<double>& weights,
                                 const Eigen::Vector3d& center);

}  // namespace dismantle::geometry
