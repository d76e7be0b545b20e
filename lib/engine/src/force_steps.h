/// Takes apart what a sequence planner has left together: verified steps where there are any, else forced ones.
#pragma once

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "dismantle/engine/run.h"
#include "force_budget.h"
#include "forced_motions.h"
#include "oracle.h"
#include "path_normalizer.h"
#include "plan_builder.h"

namespace dismantle {

class ForceSteps {
 public:
  /// All outlive it. `observer`: gets the verified removals; those that were taken apart before are not repeated.
  ForceSteps(const Assembly& assembly, const Verifier& verifier, Oracle& oracle, PlanBuilder& builder,
             SequencePlanner& planner, SequenceObserver& observer, const RunOptions& options);

  /// Until nothing is left to take apart, or cancelled: forces the part or group out that cuts in least above what it
  /// overlaps when assembled, then removes what verified paths are found for. Without a deadline the result depends on
  /// nothing but the question. With one, motions are compared as long as there is time, and each part that is left then
  /// still gets a step, of the most promising motion among few, as far as ForceBudget::for_all() allows.
  void run(RunContext& context);

 private:
  /// A motion and how deep it cuts in; `exact`: measured to its end.
  struct Choice {
    ForcedMotion motion;
    std::optional<MotionDepth> depth{};
    bool exact = false;
    double excess() const { return depth ? depth->excess() : 0; }
  };
  std::vector<const ForcedMotion*> chosen(const std::vector<ForcedMotion>& all) const;
  std::optional<Choice> quick_choice(const RunContext& context);
  std::optional<Choice> best_of(const std::vector<const ForcedMotion*>& list, const RunContext& context);
  std::optional<Choice> measured_choice(const RunContext& context);
  bool is_valid(const Choice& choice, RunContext& context);
  bool force_one(ForceBudget& budget, const RunContext& context);
  void take_apart(const ForceBudget& budget, RunContext& context);
  std::size_t steps_left() const;

  const Assembly& assembly_;
  const Verifier& verifier_;
  Oracle& oracle_;
  PlanBuilder& builder_;
  SequencePlanner& planner_;
  SequenceObserver& observer_;
  const RunOptions& options_;
  ForcedMotions motions_;
  PathNormalizer normalizer_;
  std::set<std::vector<PartId>> tried_;  // groups that were given to the sequence planner since they are what they are
};

}  // namespace dismantle
