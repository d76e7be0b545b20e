/// Rebuilds the assembly of a plan file from its input files.
#pragma once

#include "dismantle/export.h"
#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "dismantle/preparation/read_input.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// Prepares only the parts of the plan, with the plan's scale and centre, for verification. Overlaps are measured
/// again, surfaces are repaired as for the plan, nothing is subdivided. `input` was read from `source`.
/// @throws InputError when `input` is not what the plan was made for (other bytes, other parts), or a part of the plan
/// cannot be used. @throws Error when `context` wants to stop.
DISMANTLE_API Assembly assembly_of_plan(const Plan& plan, InputParts input, const std::string& source,
                                        RunContext& context);

}  // namespace dismantle
