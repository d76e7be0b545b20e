#include "dismantle/ompl/targetless.h"

#include <algorithm>
#include <numeric>

namespace dismantle::sampling {

std::array<int, 6> exits_by_distance(const SamplingProblem& problem, const SamplingProblem::StateType& from) {
  std::array<int, 6> order{};
  std::array<double, 6> distance{};
  std::iota(order.begin(), order.end(), 0);
  for (const int side : order)
    distance[static_cast<std::size_t>(side)] = problem.space().distance(from, problem.exit(from, side));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return distance[static_cast<std::size_t>(a)] < distance[static_cast<std::size_t>(b)];
  });
  return order;
}

std::optional<TargetRule::Target> NearestExit::target(TargetTree& tree, Rng& rng) {
  StateType drawn;
  problem_.space().draw(rng, drawn);
  const std::uint32_t node = tree.nearest(drawn);
  tried_.resize(tree.size(), 0);
  if (tried_[node] == 6) return std::nullopt;
  const int side = exits_by_distance(problem_, tree.state(node))[tried_[node]++];
  return Target{node, problem_.exit(tree.state(node), side)};
}

}  // namespace dismantle::sampling
