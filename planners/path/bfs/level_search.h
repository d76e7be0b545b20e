/// Algorithm 1 in one motion space, as implemented in the code published with the paper.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "dismantle/path/resume.h"
#include "dismantle/path/state_set.h"
#include "dismantle/path_planner.h"
#include "dismantle/plugin/search_recorder.h"
#include "parameters.h"

namespace dismantle::bfs {

/// A state where a run ended.
struct Node {
  State state;
  std::int32_t parent = -1;
  unsigned depth = 0;        ///< actions from the start
  Path distance{};           ///< instants after the parent's, up to this state's
  std::size_t instants = 0;  ///< number of instants from the start
};

/// The states that a search in one motion space has reached.
struct Levels {
  std::vector<Node> nodes;          ///< parents before their children
  std::vector<std::int32_t> level;  ///< states of the current depth, in the order of expansion
  std::vector<std::int32_t> next;   ///< children of the states in `level`
  std::size_t at = 0;               ///< index of the first state in `level` that has not had all actions
  std::size_t action = 0;           ///< index of that state's next action
  std::vector<path::ContactSample> samples;
  std::uint64_t work = 0;  ///< simulated steps spent so far
};

/// The tree grows level by level. Each action is applied to a state in planning time steps, each from rest, until the
/// part is separated or similar to a state on its own path from the start. The end of the run is a state of the next
/// level.
class LevelSearch {
 public:
  enum class End { searched, solved, paused, stopped, refused };

  /// `earlier`: null, or the levels of an earlier search among the same parts.
  LevelSearch(const PathQuery& query, MotionSpace space, const Parameters& parameters, RunContext& context,
              const Levels* earlier);

  /// Applies all actions to all states of depth below `depth`. Counts `steps_left` down; null: no limit. Pauses between
  /// two states after `pause_after` simulated steps of this call; 0: never.
  End run(unsigned depth, const Deadline& deadline, std::uint64_t* steps_left, std::uint64_t pause_after,
          PathResult& result);
  /// True if all states have had all actions.
  bool exhausted() const { return levels_.at == levels_.level.size() && levels_.next.empty(); }
  bool starts_out() { return world_->separated(levels_.nodes.front().state); }
  const Levels& levels() const { return levels_; }
  /// Sets statistics, blocking parts and the furthest pose.
  void report(PathResult& result) const;

 private:
  void begin();
  double remember(const State& state);
  std::int32_t add(Node node);
  void next_level();
  End expand(std::int32_t from, PathResult& result);
  End follow(std::int32_t from, const Action& action, const path::StateSet& passed, PathResult& result);
  End verify(std::int32_t last, PathResult& result);
  Path path_to(std::int32_t node) const;
  bool over() const;

  const PathQuery& query_;
  const Parameters& parameters_;
  RunContext& context_;
  std::unique_ptr<World> world_;
  std::vector<path::Ball> bodies_;
  std::vector<Action> actions_;
  path::StateSet ends_;  ///< ends of the runs so far
  Levels levels_;
  SearchRecord record_;
  Deadline deadline_;
  std::uint64_t* steps_left_ = nullptr;
  std::map<PartId, std::uint64_t> touched_;
  std::vector<Pose> best_;
  double farthest_ = -1;
  std::uint64_t steps_ = 0, expanded_ = 0, refused_ = 0, spared_ = 0, resumed_ = 0;
};

}  // namespace dismantle::bfs
