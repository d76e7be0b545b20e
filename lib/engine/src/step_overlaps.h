/// Which steps use an overlap that parts have when assembled, and how deep the parts are along the step.
#pragma once

#include <vector>

#include "dismantle/disassembly.h"
#include "dismantle/plan.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// [k]: the pairs that step k moves relative to each other and that may overlap by more than `least` (assembly units),
/// with their largest depth along the step. Empty from the step at which `context` asks to stop.
std::vector<std::vector<PlanStepOverlap>> step_overlaps(const Disassembly& done, const Assembly& assembly,
                                                        const Verifier& verifier, double least,
                                                        const RunContext& context);

}  // namespace dismantle
