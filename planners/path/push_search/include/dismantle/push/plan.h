/// A path planner's answer by push search.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "dismantle/path_planner.h"
#include "dismantle/push/search.h"
#include "dismantle/push/tactics.h"

namespace dismantle::push {

/// What the simulator has to be capable of.
Capabilities required();
/// Has the simulator all of that, for all moving parts?
bool supported(const PathQuery& query);

/// Search by translation and by rotation in turns of growing rank, until both are exhausted: what is new to each kind
/// of motion comes before the rest of the other.
class ByTurns {
 public:
  /// All three outlive this.
  ByTurns(const PathQuery& query, const Tactics& tactics, RunContext& context);

  /// Goes on where the last call stopped; Limits::rank is its own affair. `depth_limit`: it was paused.
  PathResult run(const Search::Limits& limits);
  bool paused() const { return paused_; }
  /// After the deadline of a call, where the search has more time: another call goes on.
  void go_on();
  /// What both have reached.
  std::shared_ptr<const Reached> reached() const;

 private:
  const PathQuery& query_;
  const Tactics& tactics_;
  RunContext& context_;
  Search translation_;
  std::optional<Search> rotation_;
  PathResult first_, second_;  ///< what each said last
  unsigned rank_ = 0;
  bool turning_ = false;  ///< whose turn it is
  bool paused_ = false;
};

/// Searches in the motion space that the tactics name, or, with `motion: auto`, by translation and by rotation:
/// in turns of growing rank until both are exhausted; under a depth limit with a number of states for each.
/// Goes on from PathQuery::resume_from where that is one of its own, and says what it has reached where it finds
/// nothing. `between`: see Search::Limits.
PathResult plan(const PathQuery& query, const Tactics& tactics, RunContext& context,
                const std::function<void()>& between = {});

}  // namespace dismantle::push
