/// Parts in random order: the baseline for all other orders.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/sequence_planner.h"

namespace dismantle {

struct RandomParams {
  unsigned max_depth = 0;
  static void describe(Schema<RandomParams>& schema);
};

class Random final : public SequencePlanner {
 public:
  explicit Random(const RandomParams& params) : params_(params) {}
  SequencePlannerTraits traits() const noexcept override { return {.any_start = true}; }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override;

 private:
  RandomParams params_;
};

}  // namespace dismantle
