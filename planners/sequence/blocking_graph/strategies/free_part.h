/// Removes a subassembly that nothing blocks along some direction; with an objective, the one that it likes best.
#pragma once

#include "blocking_graph/straight_motion.h"
#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

class FreePart final : public Strategy {
 public:
  FreePart(DisassemblyState& state, StraightMotion& straight, DirectionFilter filter = DirectionFilter::any)
      : state_(state), straight_(straight), filter_(filter) {}
  std::string_view name() const noexcept override { return "free_part"; }
  Cost cost() const noexcept override { return Cost::pair_sweeps; }
  Result apply(GroupState& group) override;

 private:
  Result apply_preferred(GroupState& group);

  DisassemblyState& state_;
  StraightMotion& straight_;
  DirectionFilter filter_;
};

}  // namespace dismantle::blocking
