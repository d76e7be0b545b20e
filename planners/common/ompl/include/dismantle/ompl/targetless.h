/// Goals of Targetless-RRT (Aguinaga, Borro and Matey 2008): the nearest exits of the box.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "dismantle/ompl/target_tree.h"

namespace dismantle::sampling {

/// The current node is the one nearest to a random state. Its goal is the nearest state with the same orientation whose
/// box is outside the box of the fixed parts. A node already extended towards its nearest exit gets the next nearest
/// one the next time, because repeating the extension would end in the same state.
class NearestExit final : public TargetRule {
 public:
  explicit NearestExit(SamplingProblem& problem) : problem_(problem) {}
  std::optional<Target> target(TargetTree& tree, Rng& rng) override;

 private:
  SamplingProblem& problem_;
  std::vector<std::uint8_t> tried_;  ///< by node: number of its exits that were tried
};

/// The six exits of the box, nearest first; of equal ones, the lower side first (-x, +x, -y, ...).
std::array<int, 6> exits_by_distance(const SamplingProblem& problem, const SamplingProblem::StateType& from);

}  // namespace dismantle::sampling
