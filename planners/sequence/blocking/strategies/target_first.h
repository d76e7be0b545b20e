/// One step towards the target part: the target itself if it is free, else a free one among those in its way.
#pragma once

#include "blocking_graph/straight_motion.h"
#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

class TargetFirst final : public Strategy {
 public:
  TargetFirst(DisassemblyState& state, StraightMotion& straight) : state_(state), straight_(straight) {}
  std::string_view name() const noexcept override { return "target_first"; }
  Cost cost() const noexcept override { return Cost::pair_sweeps; }
  Result apply(GroupState& group) override;

 private:
  DisassemblyState& state_;
  StraightMotion& straight_;
};

}  // namespace dismantle::blocking
