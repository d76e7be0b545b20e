#include "dismantle/ompl/state_tree.h"

namespace dismantle::sampling {

std::uint32_t StateTree::add_root(const StateType& state) {
  return add(state, static_cast<std::uint32_t>(nodes_.size()));
}

std::uint32_t StateTree::add(const StateType& state, std::uint32_t parent) {
  nodes_.push_back({state, parent});
  const std::uint32_t id = near_.add(state.center);
  const auto distance = [&](std::uint32_t n) {
    return (nodes_[n].state.center - nodes_[0].state.center).squaredNorm();
  };
  if (distance(id) > distance(farthest_)) farthest_ = id;
  return id;
}

void StateTree::discard(std::uint32_t node) {
  near_.remove(node);
  for (std::uint32_t n = node + 1; n < nodes_.size(); ++n)  // children come after their parents
    if (nodes_[n].parent != n && nodes_[n].parent >= node && near_.removed(nodes_[n].parent)) near_.remove(n);
}

void StateTree::clear() {
  nodes_.clear();
  near_ = {};
  farthest_ = 0;
}

std::uint32_t StateTree::nearest(const StateType& state) const {
  return near_.nearest(state.center, [&](std::uint32_t n) { return space_.distance(nodes_[n].state, state); });
}

std::vector<std::uint32_t> StateTree::to_root(std::uint32_t node) const {
  std::vector<std::uint32_t> nodes{node};
  while (nodes_[node].parent != node) nodes.push_back(node = nodes_[node].parent);
  return nodes;
}

}  // namespace dismantle::sampling
