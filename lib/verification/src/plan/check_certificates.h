/// Checks the proofs in a plan again.
#pragma once

#include <string>
#include <vector>

#include "dismantle/verification/check_plan.h"
#include "plan/plan_state.h"

namespace dismantle {

/// What is wrong with the certificates of a plan, and with what it says of unsolved parts because of them. `motions`:
/// the disassembly steps, from the assembled state on.
std::vector<std::string> problems_of_certificates(const Plan& plan, const Assembly& assembly, const Verifier& verifier,
                                                  const PlanState& state, const std::vector<StepMotion>& motions,
                                                  const ProverOfKind& prover_of, const RunContext& context);

}  // namespace dismantle
