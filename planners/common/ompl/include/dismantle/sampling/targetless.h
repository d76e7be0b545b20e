/// Goals of Targetless-RRT (Aguinaga, Borro and Matey 2008): out of the box by the shortest way.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "dismantle/sampling/target_tree.h"

namespace dismantle::sampling {

/// The current node is the one nearest to a random state; its goal is the nearest state, orientation kept, whose box
/// is outside the box of the rest. A node that was extended to its nearest exit gets the next nearest, and so on: the
/// same extension again would end at the same place.
class NearestExit final : public TargetRule {
 public:
  explicit NearestExit(SamplingProblem& problem) : problem_(problem) {}
  std::optional<Target> target(TargetTree& tree, Rng& rng) override;

 private:
  SamplingProblem& problem_;
  std::vector<std::uint8_t> tried_;  ///< by node: how many of its exits
};

/// The six ways out of the box, shortest first; of equals the lower side (-x, +x, -y, ...).
std::array<int, 6> exits_by_distance(const SamplingProblem& problem, const SamplingProblem::StateType& from);

}  // namespace dismantle::sampling
