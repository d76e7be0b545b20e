/// Removes what reaches highest of that which nothing blocks, so that the reverse builds from bottom to top. A group
/// that the file states leaves whole, if it can.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "blocking_graph/stated_groups.h"
#include "blocking_graph/straight_motion.h"
#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

class HighestFirst final : public Strategy {
 public:
  /// Along directions that the filter admits. References must outlive this.
  HighestFirst(DisassemblyState& state, StraightMotion& straight, const StatedGroups& stated, DirectionFilter filter)
      : state_(state), straight_(straight), stated_(stated), filter_(filter) {}
  std::string_view name() const noexcept override { return "highest_first"; }
  Cost cost() const noexcept override { return Cost::pair_sweeps; }
  Result apply(GroupState& group) override;
  void on_group_changed(GroupState& group, const GroupChange& change) override;

 private:
  struct Item {
    Subassemblies ids;
    double top = 0;
  };
  double top_of(const Subassemblies& ids) const;
  bool leaves(GroupState& group, const Subassemblies& ids, std::span<const SubassemblyId> next);
  bool group_leaves(GroupState& group, const Subassemblies& ids);

  DisassemblyState& state_;
  StraightMotion& straight_;
  const StatedGroups& stated_;
  DirectionFilter filter_;
  std::map<std::pair<Subassemblies, std::size_t>, SubassemblyId> blocker_;  // of groups: by direction, one blocker
};

}  // namespace dismantle::blocking
