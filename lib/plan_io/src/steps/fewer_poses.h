/// Motions as they are drawn: with fewer poses than a plan has to have.
#pragma once

#include <cstddef>
#include <vector>

#include "dismantle/plan.h"

namespace dismantle {

/// The same motions without most of the poses at which all parts go on straight ahead at one speed: these lie between
/// those that are kept, at equal distances. PlanStep::transfer is the same pose. A straight stretch keeps some, since
/// what is drawn along it may be bent when the whole assembly is turned meanwhile. A forced step keeps all: the two
/// directions share numbers of poses.
/// @return what is kept: numbers of poses of the step as it was, ascending.
std::vector<std::size_t> leave_out_poses(PlanStep& step);

/// Only what a timeline() reads: number, motions, and how the assembly lies.
PlanStep drawn_step(const PlanStep& step);

}  // namespace dismantle
