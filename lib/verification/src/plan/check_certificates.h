/// Checks the certificates in a plan.
#pragma once

#include <string>
#include <vector>

#include "dismantle/verification/check_plan.h"
#include "plan/plan_state.h"

namespace dismantle {

/// Problems of the certificates of a plan, and of its statements about unsolved parts that refer to them. `motions`:
/// the disassembly steps, from the assembled state on.
std::vector<std::string> problems_of_certificates(const Plan& plan, const Assembly& assembly, const Verifier& verifier,
                                                  const PlanState& state, const std::vector<StepMotion>& motions,
                                                  const ProverOfKind& prover_of, const RunContext& context);

}  // namespace dismantle
