/// Trees of states: the nodes of every tree planner.
#pragma once

#include <cstdint>
#include <vector>

#include "dismantle/ompl/nearest.h"
#include "dismantle/ompl/sampling_problem.h"

namespace dismantle::sampling {

/// Nodes 0, 1, 2, ... in order of addition, children after their parents. A root is its own parent.
class StateTree {
 public:
  using StateType = SamplingProblem::StateType;

  /// `space` must outlive this object.
  explicit StateTree(const DisplacementSpace& space) : space_(space) {}

  std::uint32_t add_root(const StateType& state);
  std::uint32_t add(const StateType& state, std::uint32_t parent);
  /// Removes a node other than a root, with its subtree.
  void discard(std::uint32_t node);
  void clear();

  std::size_t size() const { return nodes_.size(); }  ///< discarded ones included
  bool discarded(std::uint32_t node) const { return near_.removed(node); }
  const StateType& state(std::uint32_t node) const { return nodes_[node].state; }
  std::uint32_t parent(std::uint32_t node) const { return nodes_[node].parent; }
  std::uint32_t nearest(const StateType& state) const;
  /// From the node to its root, both included.
  std::vector<std::uint32_t> to_root(std::uint32_t node) const;
  /// The node whose centre is furthest from the first root.
  std::uint32_t farthest() const { return farthest_; }

 private:
  struct Node {
    StateType state;
    std::uint32_t parent = 0;
  };
  const DisplacementSpace& space_;
  std::vector<Node> nodes_;
  NearestNodes near_;
  std::uint32_t farthest_ = 0;
};

}  // namespace dismantle::sampling
