/// A strategy removes subassemblies from a group, or prepares a removal. A planner is a list of strategies.
#pragma once

#include <string>
#include <string_view>

#include "blocking_graph/state.h"

namespace dismantle::blocking {

/// The usual cost of a strategy that finds nothing. The list is in this order.
enum class Cost {
  pair_sweeps,       ///< straight sweeps of pairs, cached: fractions of a second
  arrangements,      ///< a search over arrangements of parts: up to a few seconds
  arc_sweeps,        ///< sweeps of rotating parts: up to a few seconds
  limited_search,    ///< path searches of limited depth
  unlimited_search,  ///< path searches that may take all the time that is left
};

/// What the planner does after a strategy.
enum class Result {
  unchanged,  ///< the next strategy is tried
  restart,    ///< the group has changed, or earlier strategies may find more now: the first strategy is next
  defer,      ///< this group is queued behind the others
};

/// A strategy keeps its results for a group (PerGroup) until the group changes.
class Strategy : public GroupListener {
 public:
  virtual std::string_view name() const noexcept = 0;
  virtual Cost cost() const noexcept = 0;
  /// Called with groups of two or more subassemblies. Returns early when state.stop().
  virtual Result apply(GroupState& group) = 0;
  void on_group_changed(GroupState&, const GroupChange&) override {}
  /// A note for the report when the group was given up; may be empty.
  virtual std::string failure_note(const GroupState&) const { return {}; }
};

}  // namespace dismantle::blocking
