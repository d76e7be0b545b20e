/// The screw that a part has followed.
#pragma once

#include <Eigen/Core>

#include "dismantle/geometry/twist.h"
#include "dismantle/pose.h"

namespace dismantle::push {

/// The screw from `from` to `to`, with an axis near that of `rough` and a rotation of about `turned` rad (correct to
/// within half a turn). If both poses are clear of the surfaces, it is more accurate than a screw fitted to contacts,
/// and more so the longer the motion. The linear velocity of the result is that of `local_center` (frame of the part)
/// at `to`; |linear| + radius |angular| = 1. If the rotation does not determine its axis (nearly a whole number of
/// turns), the axis of `rough` is kept.
geometry::Twist fitted_screw(const geometry::Twist& rough, const Pose& from, const Pose& to,
                             const Eigen::Vector3d& local_center, double radius, double turned);

}  // namespace dismantle::push
