/// Takes the plan of another sequence planner and looks for an order that the objective likes better.
#pragma once

#include <memory>

#include "dismantle/parameters.h"
#include "dismantle/sequence_planner.h"

namespace dismantle {

struct BestOrderParams {
  PluginRef<SequencePlanner> of;
  double effort = 60000;
  static void describe(Schema<BestOrderParams>& schema);
};

class BestOrder final : public SequencePlanner {
 public:
  explicit BestOrder(const BestOrderParams& params);
  SequencePlannerTraits traits() const noexcept override { return traits_; }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override;

 private:
  BestOrderParams params_;
  std::shared_ptr<SequencePlanner> inner_;
  SequencePlannerTraits traits_;
};

}  // namespace dismantle
