/// Disassembles by blocking graphs, the cheapest strategy first; path searches are the last resort.
#pragma once

#include "blocking/parameters.h"
#include "dismantle/sequence_planner.h"

namespace dismantle {

class Blocking final : public SequencePlanner {
 public:
  explicit Blocking(const BlockingParameters& params) : params_(params) {}
  SequencePlannerTraits traits() const noexcept override {
    return {.keeps_constraints = true, .any_start = true, .follows_objective = true};
  }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override;

 private:
  BlockingParameters params_;
};

}  // namespace dismantle
