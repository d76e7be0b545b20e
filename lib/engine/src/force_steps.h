/// Takes apart the groups that a sequence planner left together: by verified steps where possible, else by forced ones.
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
  /// All references must outlive it. `observer` gets the verified removals that are found here, not the earlier ones.
  ForceSteps(const Assembly& assembly, const Verifier& verifier, Oracle& oracle, PlanBuilder& builder,
             SequencePlanner& planner, SequenceObserver& observer, const RunOptions& options);

  /// Repeats until everything is apart or the run is cancelled: forces out the part or group that cuts in least above
  /// its assembled overlap, then removes the parts for which verified paths are found. Without a deadline the result
  /// depends only on the question. With one, motions are compared while there is time; then each remaining part still
  /// gets a step, along the most promising of a few motions, as far as ForceBudget::for_all() allows.
  void run(RunContext& context);

 private:
  /// A motion and how deep it cuts in; `exact`: the measurement was completed.
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
  std::set<std::vector<PartId>> tried_;  // groups, by their parts, that the sequence planner was already given
};

}  // namespace dismantle
