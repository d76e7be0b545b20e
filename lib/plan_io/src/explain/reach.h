/// How far a part came that did not come out.
#pragma once

#include "dismantle/plan.h"

namespace dismantle {

/// The displacement from the last pose of a part in the plan to its best one.
struct Reach {
  double travel = 0;   ///< of a point of the part, input units
  double turn = 0;     ///< rad
  bool moved = false;  ///< by more than what rounding does
};

/// `point`: of the part, assembled, input units.
Reach reach_of(const Plan& plan, const Pose& last, const Pose& best, const Eigen::Vector3d& point);

}  // namespace dismantle
