/// Push search in a simulator: Algorithm 1 and its extensions.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "dismantle/path_planner.h"
#include "dismantle/push_search/problem.h"
#include "dismantle/push_search/proposals.h"
#include "dismantle/push_search/state_tree.h"
#include "dismantle/push_search/verification.h"
#include "dismantle/push_search/work.h"

namespace dismantle::push {

/// One search in one motion space. States form a tree; each has the instants of the motion from its parent.
///
/// A translating run ends where the part stops, because under a constant force it cannot move in circles. States in the
/// middle of such runs are expanded last. A run with rotation can move in circles, and often has to be stopped
/// half-way: the state after each planning time step is a node, and the run ends at known states.
class Search {
 public:
  /// Resumes from PathQuery::resume_from if that is a Reached with a tree of this motion space.
  Search(const PathQuery& query, MotionSpace space, const Tactics& tactics, RunContext& context);

  /// Call it before the first run(). The search begins with `tree`, the result of tree() of an earlier search with the
  /// same moving parts, the same poses, and these fixed parts and perhaps others. States where runs ended at those
  /// other parts are expanded again; other runs are not repeated.
  void resume(const Tree& tree);
  /// The search tree so far.
  Tree tree() const;
  /// Simulated steps and state checks saved by resume().
  std::uint64_t spared() const { return resumed_.spared; }

  /// True if the search follows screws under `motion: auto`, and only screws lead out (screw_leads_out()).
  bool needs_screw() const;

  /// Continues where the last call stopped. `depth_limit`: states of greater depth or rank are left; `exhausted`: none.
  PathResult run(const Limits& limits);
  /// Simulated steps and state checks of all calls.
  std::uint64_t cost() const { return work_.total(); }
  /// The last call ended because of Limits::pause_after.
  bool paused() const { return paused_; }

 private:
  void clear();
  void restart();
  RunEnd verify_resumed(PathResult& result);
  RunEnd sweep_all(PathResult& result);
  RunEnd sweep(std::uint64_t expansions, PathResult& result);
  RunEnd expand(std::int32_t node, PathResult& result);
  RunEnd follow(std::int32_t from, const Action& action, Stage stage, unsigned depth, PathResult& result);
  RunEnd follow_screw(std::int32_t from, const geometry::Twist& screw, unsigned depth, PathResult& result);
  RunEnd end_run(const State& state, std::int32_t from, std::int32_t last, Path motion, Stage stage, unsigned depth);
  RunEnd verify(std::int32_t last, std::int32_t from, PathResult& result);
  std::vector<PartId> count_touched(const State& state);
  void set_outcome(RunEnd end, PathResult& result) const;
  void report(PathResult& result) const;

  /// Work, expansions and nodes of the resumed tree.
  struct Resumed {
    std::uint64_t spared = 0, expanded = 0, nodes = 0;
  };

  const RunContext& context_;
  std::unique_ptr<Problem> problem_;  ///< not moved, since the tree and the verification refer to it
  StateTree tree_;
  Verification verification_;
  Work work_;
  Limits limits_;
  bool begun_ = false;  ///< run() has been called
  bool paused_ = false;
  bool sweep_paused_ = false;    ///< paused under a limit of expansions, which stays in force
  std::uint64_t sweep_end_ = 0;  ///< number of expansions at which the sweep ends
  std::uint64_t expanded_ = 0, expanded_before_ = 0;
  bool relaxed_ = false;       ///< World::allow_overlap_everywhere
  bool short_glides_ = false;  ///< the verifier has refused a glide
  bool others_left_ = false;   ///< fixed parts of the resumed search are absent now
  Resumed resumed_;
  std::map<PartId, std::uint64_t> touched_;
};

/// The result of the later search, with the statistics and obstacles of the earlier one.
PathResult merged(const PathResult& earlier, PathResult later);

}  // namespace dismantle::push
