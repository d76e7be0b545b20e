/// Planning: assembly + planners -> verified plan.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/engine/force_options.h"
#include "dismantle/engine/layout.h"
#include "dismantle/engine/proof_options.h"
#include "dismantle/export.h"
#include "dismantle/immobility_prover.h"
#include "dismantle/path_oracle.h"
#include "dismantle/plan.h"
#include "dismantle/run_context.h"
#include "dismantle/sequence_planner.h"
#include "dismantle/transfer_planner.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// A prover and its id, which names the kind of its certificates.
struct NamedProver {
  std::string id;
  std::shared_ptr<const ImmobilityProver> prover;
};

/// The plugins of a run. The functions create one object per thread.
struct PlanningSetup {
  std::shared_ptr<Simulator> simulator;
  std::function<std::shared_ptr<PathPlanner>()> path_planner;
  std::shared_ptr<SequencePlanner> sequence_planner;  ///< unused when `only_part` is set
  std::string path_planner_id;
  /// Empty: assembly steps begin where the disassembly ended.
  std::function<std::shared_ptr<TransferPlanner>()> transfer_planner;
  std::string transfer_planner_id;
  std::vector<NamedProver> provers{};  ///< asked in this order; empty: no proofs
};

/// Limits and switches of one run.
struct RunOptions {
  double path_timeout = 120;     ///< seconds per attempt, 0 = none
  std::uint64_t path_steps = 0;  ///< simulated steps per attempt, 0 = none
  std::string only_part;         ///< plan just this part's path, all others fixed
  VerifyOptions verify;
  ProofOptions proofs;
  ForceOptions force;  ///< not used for `only_part`
  /// Pairs whose overlap, as assembled or as allowed by the user, exceeds this are named in each step that uses it;
  /// assembly units, >= 0.
  double named_overlap = 0.1;
  LayoutOptions layout;  ///< used when there is a transfer planner
  std::uint64_t seed = 1;
  Constraints constraints;
  std::vector<FlexiblePart> flexible{};  ///< flexible parts, for the plan to state
};

/// Result of a run.
struct RunResult {
  Plan plan;
  Outcome outcome = Outcome::crashed;
  OracleCounts counts;
  std::map<std::string, double>
      planner_counts;  ///< PathResult::stats of all attempts that were planned, summed by name
  std::map<std::string, double> sequence_counts;                ///< SequenceResult::counts
  std::vector<std::pair<std::string, std::string>> precedence;  ///< (before, after)
  double prepare_seconds = 0;                                   ///< simulator preparation
  double plan_seconds = 0;
  double proof_seconds = 0;  ///< of immobility provers, summed over all threads; not part of the time of attempts
};

/// Runs to the end, the deadline or cancellation; in each case the result holds every finished step.
/// `on_step` (may be empty) is called after each step with the plan so far.
DISMANTLE_API RunResult run(const Assembly& assembly, const PlanningSetup& setup, const RunOptions& options,
                            RunContext& context, const std::function<void(const Plan&)>& on_step = {});

/// The plan before the first step: what can be saved if a plugin never returns.
DISMANTLE_API Plan plan_before_first_step(const Assembly& assembly, const RunOptions& options);

/// The oracle that `run` uses; public for tests and for sequence planners' authors.
DISMANTLE_API std::unique_ptr<PathOracle> make_oracle(const Assembly& assembly, const PreparedAssembly& prepared,
                                                      const PlanningSetup& setup, const RunOptions& options,
                                                      const Verifier& verifier, RunContext& context);

}  // namespace dismantle
