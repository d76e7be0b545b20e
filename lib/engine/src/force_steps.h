/// Takes apart what a sequence planner has left together: verified steps where there are any, else forced ones.
#pragma once

#include <set>
#include <vector>

#include "dismantle/engine/run.h"
#include "forced_motions.h"
#include "oracle.h"
#include "path_normalizer.h"
#include "plan_builder.h"

namespace dismantle {

class ForceSteps {
 public:
  /// All outlive it. `observer`: told of verified removals; those that were taken apart before are not repeated.
  ForceSteps(const Assembly& assembly, const Verifier& verifier, Oracle& oracle, PlanBuilder& builder,
             SequencePlanner& planner, SequenceObserver& observer, const RunOptions& options);

  /// Until nothing is left to take apart, or told to stop: forces the part or group out that cuts in least above what
  /// it overlaps when assembled, then removes what verified paths are found for. `unfinished`: the sequence planner was
  /// stopped before its end, so that verified paths are looked for first.
  void run(bool unfinished, RunContext& context);

 private:
  std::vector<const ForcedMotion*> chosen(const std::vector<ForcedMotion>& all) const;
  const ForcedMotion* best_of(const std::vector<const ForcedMotion*>& list, const RunContext& context);
  bool force_one(const RunContext& context);
  void take_apart(RunContext& context);

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
