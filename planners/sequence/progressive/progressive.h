/// Algorithm 2 of Tian et al. 2022: searches for a removal of each part, one level deeper in each round.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/sequence_planner.h"
#include "one_by_one/one_by_one.h"

namespace dismantle {

struct ProgressiveParameters {
  PartOrder order = PartOrder::small_first;
  unsigned max_depth = 0;
  bool deepen_always = false;
  bool last_pair_unlimited = true;
  static void describe(Schema<ProgressiveParameters>& schema);
};

class Progressive final : public SequencePlanner {
 public:
  explicit Progressive(const ProgressiveParameters& params) : params_(params) {}
  SequencePlannerTraits traits() const noexcept override { return {.any_start = true, .follows_objective = true}; }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override;

 private:
  ProgressiveParameters params_;
};

}  // namespace dismantle
