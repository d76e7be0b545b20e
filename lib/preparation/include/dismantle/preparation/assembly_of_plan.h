/// The assembly that a plan file is for, from the input files again.
#pragma once

#include "dismantle/export.h"
#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "dismantle/preparation/read_input.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// Prepares just the parts that the plan is about, in the plan's scale and about its centre, to verify it: overlaps are
/// measured anew, surfaces are repaired as they were for the plan, nothing is subdivided. `input` is what was read from `source`.
/// @throws InputError when `input` is not what the plan was made for (other bytes, other parts), or a part of the plan
/// cannot be used. @throws Error when `context` wants to stop.
DISMANTLE_API Assembly assembly_of_plan(const Plan& plan, InputParts input, const std::string& source,
                                        RunContext& context);

}  // namespace dismantle
