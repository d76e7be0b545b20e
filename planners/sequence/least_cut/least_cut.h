/// Removes by force what no verified path is known for, where it cuts in least.
#pragma once

#include "dismantle/sequence_planner.h"
#include "least_cut/parameters.h"

namespace dismantle {

/// Makes one step and ends: of all parts and groups that are left, the one that cuts in least leaves the rest. The next
/// planner of a `chain` then looks for verified paths again. Without a deadline the step depends only on the question.
/// With one, motions are compared while there is time; otherwise the most promising of a few is taken.
class LeastCut final : public SequencePlanner {
 public:
  explicit LeastCut(const LeastCutParameters& params) : params_(params) {}
  SequencePlannerTraits traits() const noexcept override {
    return {.keeps_constraints = true, .any_start = true, .forces = true};
  }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override;

 private:
  LeastCutParameters params_;
};

}  // namespace dismantle
