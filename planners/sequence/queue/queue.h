/// Algorithm 2 of Tian et al. 2022 without a depth limit: their Full BFS and baselines (section 6.3).
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/sequence_planner.h"
#include "one_by_one/one_by_one.h"

namespace dismantle {

struct QueueParameters {
  PartOrder order = PartOrder::small_first;
  static void describe(Schema<QueueParameters>& schema);
};

class Queue final : public SequencePlanner {
 public:
  explicit Queue(const QueueParameters& params) : params_(params) {}
  SequencePlannerTraits traits() const noexcept override { return {.any_start = true}; }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override;

 private:
  QueueParameters params_;
};

}  // namespace dismantle
