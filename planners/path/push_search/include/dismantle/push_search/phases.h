/// Searches by translation and by rotation one after the other.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "dismantle/push_search/reached.h"
#include "dismantle/push_search/search.h"

namespace dismantle::push {

/// A search in one motion space, and what it may use.
struct Phase {
  MotionSpace space = MotionSpace::translation;
  unsigned rank = ~0U;
  std::uint64_t expansions = 0;            ///< states, 0 = no limit
  std::optional<std::uint64_t> most_work;  ///< absent: all that is left
};

/// The phases of a query: the motion space of the tactics or, with `motion: auto` and a depth limit, both.
std::deque<Phase> phases_of(const PathQuery& query, const Tactics& tactics);

/// Runs the phases in order. Only a phase that is exhausted is followed by the next one. If only a screw leads out, a
/// phase for screws comes before the others.
class Phases {
 public:
  /// All arguments outlive this.
  Phases(const PathQuery& query, const Tactics& tactics, RunContext& context);

  /// Continues where the last call stopped. Sets `result`. Limits::rank and Limits::expansions are those of the phases.
  SearchStatus run(Limits limits, PathResult& result);
  /// The search trees of the phases so far.
  std::shared_ptr<const Reached> reached();

 private:
  void begin();
  void begin_phase(Search search);
  SearchStatus run_phase(Limits limits, PathResult& result);
  PathResult run_current(Limits limits);
  void keep_tree();

  const PathQuery& query_;
  const Tactics& tactics_;
  RunContext& context_;
  std::deque<Phase> phases_;  ///< not finished, the current one first
  bool begun_ = false;
  std::optional<Search> current_;
  std::uint64_t work_left_ = 0;      ///< of the current phase, if its work is limited
  std::optional<PathResult> ended_;  ///< result of the phases that have ended
  std::shared_ptr<Reached> reached_ = std::make_shared<Reached>();
};

}  // namespace dismantle::push
