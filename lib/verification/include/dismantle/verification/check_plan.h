/// Verifies a whole plan file against its assembly.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/immobility_prover.h"
#include "dismantle/plan.h"
#include "dismantle/run_context.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// One thing that is wrong with a plan.
struct PlanProblem {
  unsigned step = 0;  ///< 0 = the plan as a whole
  std::string message;
};

/// What the check of a whole plan found.
struct PlanCheck {
  bool valid = false;      ///< every step is a valid motion that separates what it says, and every certificate holds
  bool complete = false;   ///< valid, no step is forced, and every group is down to one part
  std::size_t forced = 0;  ///< steps that are forced: not valid motions, but what is said of their depth is true
  std::size_t certificates = 0;       ///< that hold
  std::size_t checked_by_prover = 0;  ///< of these: by the prover that made them, for want of an independent checker
  double max_penetration = 0;         ///< worst certified bound over all steps
  std::vector<double> step_penetration;
  std::vector<PlanProblem> problems;
};

/// The prover that makes certificates of a kind; nullptr: there is none.
using ProverOfKind = std::function<std::shared_ptr<const ImmobilityProver>(const std::string& kind)>;

/// Certificates are checked by independent checkers (check_certificate.h); those of a kind that has none, by the prover
/// of the kind. Without either a certificate does not hold.
DISMANTLE_API PlanCheck check_plan(const Plan& plan, const Assembly& assembly, const VerifyOptions& options,
                                   RunContext& context, const ProverOfKind& prover_of = {});

}  // namespace dismantle
