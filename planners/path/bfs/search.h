/// Breadth-first search over a simulator (Algorithm 1).
#pragma once

#include <deque>
#include <map>
#include <vector>

#include "dismantle/path/state_set.h"
#include "dismantle/path_planner.h"
#include "parameters.h"

namespace dismantle::bfs {

/// One search in one motion space. States form a tree; each knows the instants that lead to it.
class Search {
 public:
  Search(const PathQuery& query, MotionSpace space, const Parameters& parameters, RunContext& context);

  /// `steps_left`: simulated steps that may still be used, updated; 0 at the start means unlimited.
  /// `max_nodes`: states to search from at most, 0 = no limit.
  PathResult run(const Deadline& deadline, std::uint64_t& steps_left, bool limited_steps, std::uint64_t max_nodes);

 private:
  struct Node {
    State state;
    std::int32_t parent = -1;
    unsigned depth = 0;   ///< actions from the start
    Path way;             ///< instants after the parent's, this one's last
    unsigned stages_done = 0;  ///< stages of actions applied so far
  };
  enum class RunEnd { blocked, solved, refused_learned, refused, stop };

  void reset();
  bool waiting_at(unsigned depth) const;
  RunEnd sweep(std::size_t stage, std::uint64_t max_nodes, PathResult& result);
  RunEnd expand(std::int32_t node, std::size_t stage, PathResult& result);
  RunEnd follow(std::int32_t from, const Action& action, PathResult& result);
  void note_contacts(const State& state);
  Path path_to(std::int32_t node) const;
  std::int32_t add_node(std::int32_t parent, unsigned depth, const State& state, Path way);
  void finish(PathResult& result) const;
  bool out_of_budget() const;

  const PathQuery& query_;
  const Parameters& parameters_;
  RunContext& context_;
  std::unique_ptr<World> world_;
  std::vector<path::Ball> bodies_;
  std::vector<std::vector<Action>> actions_;  ///< by stage: axes, then diagonals
  path::StateSet seen_, fine_;  ///< every recorded state, at the paper's and at a finer resolution
  std::vector<Node> nodes_;
  std::vector<std::deque<std::int32_t>> ends_, middles_;  ///< by depth
  Deadline deadline_;
  std::uint64_t* steps_left_ = nullptr;
  bool limited_steps_ = false;
  std::map<PartId, std::uint64_t> touched_;
  double farthest_ = -1;
  std::vector<Pose> best_;
  std::uint64_t steps_ = 0, refused_ = 0, expanded_ = 0;
};

}  // namespace dismantle::bfs
