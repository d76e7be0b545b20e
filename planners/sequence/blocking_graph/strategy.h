/// One way of getting on with a group of subassemblies. The planner is a list of these: see strategies/.
#pragma once

#include <string>
#include <string_view>

#include "blocking_graph/state.h"

namespace dismantle::blocking {

/// What a strategy costs where it finds nothing, as a rule; the list is in this order.
enum class Cost {
  pair_sweeps,       ///< straight sweeps of pairs, remembered: fractions of a second
  arrangements,      ///< a search over arrangements of parts: up to a few seconds
  quick_proofs,      ///< proofs about pairs: fractions of a second up to two each
  arc_sweeps,        ///< sweeps of rotating parts: up to a few seconds
  limited_search,    ///< path searches of limited depth
  unlimited_search,  ///< path searches that may take all the time there is
  long_proofs,       ///< proofs that take up to half a minute each
};

/// What the planner does next.
enum class Result {
  unchanged,  ///< the next strategy is tried
  restart,    ///< the group has changed, or earlier strategies may find more than before: begin with the first again
  defer,      ///< other groups come first; this group is queued behind them
};

/// A strategy keeps what it knows of a group (PerGroup) until it is told of a change.
class Strategy : public GroupListener {
 public:
  virtual std::string_view name() const noexcept = 0;
  virtual Cost cost() const noexcept = 0;
  /// Called with groups of two or more subassemblies. Returns early when state.stop().
  virtual Result apply(GroupState& group) = 0;
  void on_group_changed(GroupState&, const GroupChange&) override {}
  /// What the report says about this strategy where the group was given up; empty: nothing.
  virtual std::string failure_note(const GroupState&) const { return {}; }
};

}  // namespace dismantle::blocking
