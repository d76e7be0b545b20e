/// Forced steps that the user accepts (Constraints::accept).
#pragma once

#include "dismantle/disassembly.h"
#include "dismantle/plan.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// Marks the forced steps of `plan`, which is that of `disassembly`, that the constraints accept: the pair that cuts
/// deepest is accepted to this depth, and the step is valid for all other pairs. A plan whose forced steps are all
/// accepted is complete.
void mark_accepted(Plan& plan, const Disassembly& disassembly, const Assembly& assembly, const Constraints& constraints,
                   const Verifier& verifier, RunContext& context);

}  // namespace dismantle
