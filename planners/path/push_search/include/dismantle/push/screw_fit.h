/// The screw that a part has followed.
#pragma once

#include <Eigen/Core>

#include "dismantle/geometry/twist.h"
#include "dismantle/pose.h"

namespace dismantle::push {

/// The screw that has led from `from` to `to` by a turn of about `turned` rad (right to within a half turn) about
/// nearly `rough`. Where both poses are in the middle of their room it is closer to the truth than what contacts tell,
/// and the longer the way, the closer. `local_center` in the frame of the part, where the velocity of the result
/// belongs to; |linear| + radius |angular| = 1. Where the turn does not tell its axis (a whole number of half turns)
/// that of `rough` is kept.
geometry::Twist fitted_screw(const geometry::Twist& rough, const Pose& from, const Pose& to,
                             const Eigen::Vector3d& local_center, double radius, double turned);

}  // namespace dismantle::push
