/// A random tree of poses that may penetrate as deeply as the verifier allows.
#pragma once

#include <array>
#include <cstdint>

#include "dismantle/path_planner.h"
#include "dismantle/tolerant_walk/parameters.h"
#include "dismantle/tolerant_walk/pose_tree.h"

namespace dismantle::tolerant_walk {

/// Capabilities that the simulator needs.
inline constexpr Capabilities kNeeds{};

class RrtSearch final : public PathSearch {
 public:
  /// All arguments must outlive this object. Several moving parts move as one rigid body. Ends with `depth_limit` after
  /// `max_state_checks`; the checks of a resumed search count, up to half of that limit. Ends with `exhausted` when the
  /// checker has refused too many paths.
  RrtSearch(const Parameters& parameters, const PathQuery& query, RunContext& context, GeometryCache& cache,
            std::uint64_t max_state_checks);

  SearchStatus run(const Budget& portion) override;
  PathResult result() override;
  std::uint64_t state_checks() const { return tree_.state_checks(); }

 private:
  void update_furthest(std::uint32_t node);
  void recompute_furthest();
  std::uint32_t select_node(PoseTree::Step& step);
  bool extend();
  bool is_goal(std::uint32_t node);
  bool find_verified_path(std::uint32_t node);

  const Parameters parameters_;
  const PathQuery& query_;
  Rng rng_;
  PoseTree tree_;
  std::array<std::uint32_t, 26> furthest_{};  ///< the furthest node in each direction
  bool resumed_ = false, begun_ = false;
  std::uint64_t max_state_checks_;
  PathResult result_;
  double goal_checked_at_ = 0;  ///< distance from the start at the last check for the goal
};

}  // namespace dismantle::tolerant_walk
