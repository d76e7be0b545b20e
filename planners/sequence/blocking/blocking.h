/// Takes an assembly apart by what is in whose way; searches only where no straight motion exists.
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/sequence_planner.h"
#include "one_by_one/one_by_one.h"

namespace dismantle {

struct BlockingParams {
  PartOrder order = PartOrder::small_first;
  bool straight = true;
  bool groups = true;
  std::int64_t slide_states = 60'000;
  bool cages = true;
  bool turns = true;
  bool at_once = true;
  unsigned max_depth = 8;
  static void describe(Schema<BlockingParams>& schema);
};

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
