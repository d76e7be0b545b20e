/// How far the parts of a forced step come before they cut in.
#pragma once

#include "dismantle/disassembly.h"
#include "dismantle/plan.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// Sets PlanStep::transfer of the forced steps of `plan`, which is that of `disassembly`, to the last pose up to which
/// the step is valid; not of those that are left when `context` asks to stop.
void set_reached(Plan& plan, const Disassembly& disassembly, const Verifier& verifier, const RunContext& context);

}  // namespace dismantle
