/// Disassembles by blocking graphs, the cheapest strategy first; path searches are the last resort.
#pragma once

#include "blocking/params.h"
#include "dismantle/sequence_planner.h"

namespace dismantle {

class Blocking final : public SequencePlanner {
 public:
  explicit Blocking(const BlockingParams& params) : params_(params) {}
  bool keeps_constraints() const noexcept override { return true; }
  SequenceResult plan(const Assembly& assembly, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override;

 private:
  BlockingParams params_;
};

}  // namespace dismantle
