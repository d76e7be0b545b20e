/// Motions as they are drawn: with fewer poses than a plan has to have.
#pragma once

#include "dismantle/plan.h"

namespace dismantle {

/// The same motions without most of the poses at which all parts go on straight ahead at one speed. Interpolated poses
/// are the same, and so is PlanStep::transfer as a pose. A straight stretch keeps some, since what is drawn along it
/// may be bent when the whole assembly is turned meanwhile. A forced step keeps all: the two directions share numbers
/// of poses.
void leave_out_poses(PlanStep& step);

/// Only what a timeline() reads: number, motions, and how the assembly lies.
PlanStep drawn_step(const PlanStep& step);

}  // namespace dismantle
