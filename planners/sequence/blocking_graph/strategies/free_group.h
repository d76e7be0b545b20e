/// Removes the smallest group of subassemblies that can move together in a straight line (Wilson and Latombe 1994: the
/// strongly connected components of the directional blocking graph). The group is disassembled separately later.
#pragma once

#include "blocking_graph/straight_motion.h"
#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

class FreeGroup final : public Strategy {
 public:
  /// `proposals`: groups that are proposed to the verifier before other strategies are tried.
  FreeGroup(DisassemblyState& state, StraightMotion& straight, unsigned proposals,
            DirectionFilter filter = DirectionFilter::any)
      : state_(state), straight_(straight), proposals_(proposals), filter_(filter) {}
  std::string_view name() const noexcept override { return "free_group"; }
  Cost cost() const noexcept override { return Cost::pair_sweeps; }
  Result apply(GroupState& group) override;
  void on_group_changed(GroupState& group, const GroupChange& change) override;

 private:
  struct Candidate {
    Subassemblies ids;
    std::size_t parts = 0;
    std::size_t direction = 0;
  };
  std::vector<Candidate> candidates(const GroupState& group);

  DisassemblyState& state_;
  StraightMotion& straight_;
  unsigned proposals_;
  DirectionFilter filter_;
  PerGroup<bool> done_;
};

}  // namespace dismantle::blocking
