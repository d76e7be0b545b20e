/// Two trees that grow towards each other, as an OMPL planner.
#pragma once

#include <ompl/base/Planner.h>
#include <ompl/base/goals/GoalSampleableRegion.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "dismantle/ompl/sampling_problem.h"
#include "dismantle/ompl/state_tree.h"

namespace dismantle::sampling {

/// RRT-Connect (Kuffner and LaValle 2000): one tree from the start, one from states of the goal. In each iteration one
/// of them extends towards a random state, and the other extends towards the new node until it arrives or is blocked;
/// then they change roles. The first target after a new root of the second tree is that root.
///
/// The problem's goal is a GoalState, or a region that can be sampled. With a region, each iteration samples a root
/// until maxSampleCount() were sampled, and a node of the first tree in the region also ends the search.
///
/// Not ompl::geometric::RRTConnect, which draws its seeds from a process-wide sequence. All random numbers come from
/// the given generator. A further solve() continues with the same trees; after clear() it starts again with other
/// random numbers.
class ConnectTrees final : public ompl::base::Planner {
 public:
  using StateType = SamplingProblem::StateType;

  /// `range`: longest extension in assembly units.
  ConnectTrees(SamplingProblem& problem, double range, const Rng& rng);

  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& stop) override;
  void clear() override;

  /// From start to goal; empty before a solution was found.
  const std::vector<StateType>& solution() const { return solution_; }
  /// Removes the motion from state `edge` - 1 to `edge` of the solution from its tree, with its subtree.
  void discard(std::size_t edge);
  std::uint64_t nodes() const { return grown_ + trees_[0].size() + trees_[1].size(); }
  std::uint64_t iterations() const { return iterations_; }
  /// Of the states of the tree from the start, the one whose centre is furthest from it. Nothing before solve().
  std::optional<StateType> farthest() const {
    return trees_[0].size() > 0 ? std::optional(trees_[0].state(trees_[0].farthest())) : std::nullopt;
  }

 private:
  /// One tree extends, from its node `at`, towards the other tree's new node `meeting`.
  struct Connection {
    std::uint32_t meeting = 0, at = 0;
  };
  /// Extends up to `range` towards the target, as far as it is free. Nothing: the first step is blocked.
  std::optional<std::uint32_t> extend(StateTree& tree, std::uint32_t node, const StateType& target);
  void add_root(const ompl::base::GoalSampleableRegion& goal);
  void next_iteration();
  void report(std::uint32_t in_first, std::optional<std::uint32_t> in_second);

  SamplingProblem& problem_;
  double range_;
  Rng rng_;
  StateTree trees_[2];  // from the start, from the goal
  int growing_ = 0;
  StateType target_;
  std::optional<Connection> connection_;
  unsigned sampled_ = 0;  // goal states drawn
  std::uint64_t grown_ = 0, iterations_ = 0;
  std::vector<StateType> solution_;
  std::vector<std::uint32_t> child_of_edge_;  // by edge - 1 of the solution: the edge's child node
  std::size_t edges_of_first_ = 0;            // edges up to this one are in the first tree, the rest in the second
};

}  // namespace dismantle::sampling
