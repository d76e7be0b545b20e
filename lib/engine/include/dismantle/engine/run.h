/// Planning: assembly + planners -> verified plan.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/engine/layout.h"
#include "dismantle/engine/proof_options.h"
#include "dismantle/errors.h"
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
  std::string path_planner_id, sequence_planner_id;
  /// Empty: assembly steps begin where the disassembly ended.
  std::function<std::shared_ptr<TransferPlanner>()> transfer_planner;
  std::string transfer_planner_id;
  std::vector<NamedProver> provers{};  ///< asked in this order; empty: no proofs
  Objective objective{};               ///< empty: any order that is free of collisions
};

/// Whether parts without a verified path may be removed by force, by a sequence planner such as `least_cut`.
enum class ForceWhen { off, last_resort };

/// Limits and switches of one run.
struct RunOptions {
  double path_timeout = 120;     ///< seconds per attempt, 0 = none
  std::uint64_t path_steps = 0;  ///< simulated steps per attempt, 0 = none
  std::string only_part;         ///< plan just this part's path, all others fixed
  VerifyOptions verify;
  ProofOptions proofs;
  ForceWhen force = ForceWhen::off;  ///< PathOracle::forcing() is null when off, and for `only_part`
  /// Pairs whose overlap, as assembled or as allowed by the user, exceeds this are named in each step that uses it;
  /// assembly units, >= 0.
  double named_overlap = 0.1;
  LayoutOptions layout;  ///< used when there is a transfer planner
  std::uint64_t seed = 1;
  Constraints constraints;
  /// As SequenceQuery::start; empty: one group of all parts as assembled. Only the disassembly of a run from another
  /// start is of use: a plan file begins with the whole assembly.
  std::vector<std::vector<PlacedPart>> start{};
  /// A disassembly of the same assembly to go on from: its steps are verified again and recorded before the sequence
  /// planner starts. Not together with `start`.
  std::optional<Disassembly> resume{};
  std::vector<FlexiblePart> flexible{};  ///< flexible parts, for the plan to state
};

/// A step to go on from that is not valid.
class DISMANTLE_API StepRefused : public InputError {
 public:
  /// `step`: from 0. `subject`: the input.
  StepRefused(std::string subject, std::size_t step, std::string reason);
  ~StepRefused() override;
  std::size_t step() const { return step_; }
  const std::string& reason() const { return reason_; }

 private:
  std::size_t step_;
  std::string reason_;
};

/// Called after each step, with the steps so far and the newest of them. It may be the continuation of the step before,
/// which it then replaces.
using StepObserver = std::function<void(const Disassembly& so_far, const DisassemblyStep& newest)>;

/// Result of a run.
struct RunResult {
  Disassembly disassembly{0};
  Plan plan;  ///< of the disassembly, with all that was found out about it
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

/// Runs to the end, the deadline or cancellation; in each case the result holds every finished step. `on_step` may be
/// empty. @throws std::invalid_argument for a setup that cannot do what the options ask for. @throws StepRefused for a step
/// of `resume` that is not valid.
DISMANTLE_API RunResult run(const Assembly& assembly, const PlanningSetup& setup, const RunOptions& options,
                            RunContext& context, const StepObserver& on_step = {});

/// The plan that states these steps and nothing else: what can be saved before the run ends. Before the first step:
/// Disassembly(assembly.parts.size()).
DISMANTLE_API Plan plan_of(const Disassembly& disassembly, const Assembly& assembly, const RunOptions& options);

/// A step of a plan for this assembly. @throws InputError when it names an unknown part.
DISMANTLE_API DisassemblyStep disassembly_step(const PlanStep& step, const Assembly& assembly);
/// The steps of a plan for this assembly, the first `count` of them. @throws InputError for a step that names an unknown
/// part or parts that are not together.
DISMANTLE_API Disassembly disassembly_of(const Plan& plan, const Assembly& assembly,
                                         std::size_t count = Disassembly::kNow);

/// The oracle that `run` uses; public for tests and for sequence planners' authors.
DISMANTLE_API std::unique_ptr<PathOracle> make_oracle(const Assembly& assembly, const PreparedAssembly& prepared,
                                                      const PlanningSetup& setup, const RunOptions& options,
                                                      const Verifier& verifier, RunContext& context);

}  // namespace dismantle
