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

/// One error in a plan.
struct PlanProblem {
  unsigned step = 0;  ///< 0 = the plan as a whole
  std::string message;
};

/// Result of the check of a whole plan.
struct PlanCheck {
  bool valid = false;  ///< all motions, separations, stated depths and certificates are as the plan says
  /// Valid, every forced step is accepted by the user, and what was asked for is done (is_done()).
  bool complete = false;
  std::size_t forced = 0;             ///< forced steps: not valid motions; their stated depths were checked
  std::size_t accepted = 0;           ///< those that the user accepts; valid but for the pair that they name
  std::size_t certificates = 0;       ///< number of certificates that hold
  std::size_t checked_by_prover = 0;  ///< those checked by their prover, since there is no independent checker
  double max_penetration = 0;         ///< worst certified bound over all steps
  std::vector<double> step_penetration;
  std::vector<double> forced_depth{};  ///< by step: as measured, assembly units; 0 for steps that are not forced
  std::size_t verdicts = 0;            ///< of step checks, judged again by judge_again() (dismantle/engine/judgement.h)
  std::vector<std::string> not_checked{};  ///< "'acme.x': ...": checks and proofs whose plugin is not available
  std::vector<PlanProblem> problems;
};

/// Returns the prover that makes certificates of a kind, or nullptr if there is none.
using ProverOfKind = std::function<std::shared_ptr<const ImmobilityProver>(const std::string& kind)>;

/// A certificate is checked by the independent checker of its kind, else by the prover of its kind. One that neither
/// can check is in PlanCheck::not_checked; whether it holds is not known.
DISMANTLE_API PlanCheck check_plan(const Plan& plan, const Assembly& assembly, const VerifyOptions& options,
                                   RunContext& context, const ProverOfKind& prover_of = {});

}  // namespace dismantle
