/// Which steps make use of an overlap that the parts have when assembled, and how deep they are along the step.
#pragma once

#include <vector>

#include "dismantle/plan.h"
#include "dismantle/verification/verifier.h"
#include "plan_builder.h"

namespace dismantle {

/// [k]: the pairs of step k that may be in each other by more than `least` (assembly units) and move relative to each
/// other, each with the deepest that it is along the step. Steps from the one on at which `context` says to stop have
/// none.
std::vector<std::vector<PlanStepOverlap>> step_overlaps(const std::vector<RecordedStep>& steps,
                                                        const Assembly& assembly, const Verifier& verifier,
                                                        double least, const RunContext& context);

}  // namespace dismantle
