/// The proofs of holds in a plan: which parts suffice, and that no fewer do (the step check `gravity`).
#pragma once

#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "dismantle/run_context.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {

/// Checks the proofs of a plan that check_plan() has found valid, without the solver that made them, and adds what is
/// wrong to `check`. A step without a proof is no problem, unless it says that its holds are proved.
void check_hold_proofs(PlanCheck& check, const Plan& plan, const Assembly& assembly, const RunContext& context);

}  // namespace dismantle
