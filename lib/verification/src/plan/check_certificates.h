/// Checks the certificates in a plan.
#pragma once

#include <string>
#include <vector>

#include "dismantle/verification/check_plan.h"
#include "plan/plan_state.h"

namespace dismantle {

/// What is known about the certificates of a plan.
struct CertificateFindings {
  std::vector<std::string> problems;     ///< also those of statements about unsolved parts that refer to certificates
  std::vector<std::string> not_checked;  ///< certificates of kinds that nothing here can check
};

/// `motions`: the disassembly steps, from the assembled state on.
CertificateFindings check_certificates_of(const Plan& plan, const Assembly& assembly, const Verifier& verifier,
                                          const PlanState& state, const std::vector<StepMotion>& motions,
                                          const ProverOfKind& prover_of, const RunContext& context);

}  // namespace dismantle
