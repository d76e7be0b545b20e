/// Parts in random order: the baseline for all other orders.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/sequence_planner.h"

namespace dismantle {

struct RandomParameters {
  unsigned max_depth = 0;
  static void describe(Schema<RandomParameters>& schema);
};

class Random final : public SequencePlanner {
 public:
  explicit Random(const RandomParameters& params) : params_(params) {}
  SequencePlannerTraits traits() const noexcept override { return {.any_start = true}; }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override;

 private:
  RandomParameters params_;
};

}  // namespace dismantle
