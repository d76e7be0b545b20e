/// A random tree of poses that may penetrate as deep as the verifier allows.
#pragma once

#include <array>
#include <cstdint>

#include "dismantle/path_planner.h"
#include "dismantle/tolerant_walk/parameters.h"
#include "dismantle/tolerant_walk/pose_tree.h"

namespace dismantle::tolerant_walk {

/// What the simulator has to be capable of.
inline constexpr Capabilities kNeeds{};

class Walk final : public PathSearch {
 public:
  /// All outlive this. Several moving parts move as one rigid body. Ends with
  /// `depth_limit` when `most_looks` poses were checked, those included, up to
  /// a half, that were checked by the search that it resumes; with `exhausted`
  /// when the checker has refused too many paths.
  Walk(const Parameters& parameters, const PathQuery& query, RunContext& context, GeometryCache& cache,
       std::uint64_t most_looks);

  SearchStatus run(const Budget& portion) override;
  PathResult result() override;
  std::uint64_t looks() const { return tree_.looks(); }

 private:
  void note(std::uint32_t node);
  void note_all();
  std::uint32_t choose(PoseTree::Step& step);
  bool fly();
  bool out(std::uint32_t node);
  bool verified(std::uint32_t node);

  const Parameters parameters_;
  const PathQuery& query_;
  Rng rng_;
  PoseTree tree_;
  std::array<std::uint32_t, 26> furthest_{};  ///< nodes, by direction
  bool resumed_ = false, begun_ = false;
  std::uint64_t most_looks_;
  PathResult result_;
  double looked_at_ = 0;  ///< distance from the start at which it was last asked
                          ///< whether it is out
};

}  // namespace dismantle::tolerant_walk
