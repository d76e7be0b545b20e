/// A random tree of poses that may penetrate as deep as the judge allows.
#pragma once

#include <array>
#include <cstdint>

#include "dismantle/path_planner.h"
#include "dismantle/tolerant_walk/parameters.h"
#include "dismantle/tolerant_walk/pose_tree.h"

namespace dismantle::tolerant_walk {

/// What the simulator has to be capable of.
inline constexpr Capabilities kNeeds{};

class Walk {
 public:
  /// All three outlive this. Several moving parts move as one rigid body.
  Walk(const Parameters& parameters, const PathQuery& query, RunContext& context, GeometryCache& cache);

  /// Goes on until so many poses were looked at in all, those included, up to a half, that an earlier walk has looked
  /// at from which it goes on (PathQuery::resume_from). `depth_limit`: that is the case; `exhausted`: the judge has
  /// refused too much.
  /// `pause_after`: state checks of this call, after which it pauses; 0: none. Another call goes on.
  PathResult run(std::uint64_t most_looks, std::uint64_t pause_after = 0, const Deadline& pause_at = {});
  /// The last call ended because of `pause_after` or `pause_at`.
  bool paused() const { return paused_; }
  std::uint64_t looks() const { return tree_.looks(); }

 private:
  void note(std::uint32_t node);
  void note_all();
  std::uint32_t choose(PoseTree::Step& step);
  bool fly(PathResult& result);
  bool out(std::uint32_t node);
  bool judged(std::uint32_t node, PathResult& result);

  const Parameters parameters_;
  const PathQuery& query_;
  Rng rng_;
  PoseTree tree_;
  std::array<std::uint32_t, 26> furthest_{};  ///< nodes, by direction
  bool resumed_ = false, paused_ = false;
  double looked_at_ = 0;  ///< distance from the start at which it was last asked whether it is out
};

}  // namespace dismantle::tolerant_walk
