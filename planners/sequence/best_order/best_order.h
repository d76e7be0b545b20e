/// Takes the plan of another sequence planner and looks for an order that the objective likes better.
#pragma once

#include <memory>

#include "dismantle/parameters.h"
#include "dismantle/sequence_planner.h"

namespace dismantle {

struct BestOrderParameters {
  PluginRef<SequencePlanner> of;
  double effort = 60000;
  static void describe(Schema<BestOrderParameters>& schema);
};

class BestOrder final : public SequencePlanner {
 public:
  explicit BestOrder(const BestOrderParameters& params);
  SequencePlannerTraits traits() const noexcept override { return traits_; }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override;

 private:
  BestOrderParameters params_;
  std::shared_ptr<SequencePlanner> inner_;
  SequencePlannerTraits traits_;
};

}  // namespace dismantle
