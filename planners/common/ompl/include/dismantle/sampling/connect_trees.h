/// Two trees that grow towards each other, as an OMPL planner.
#pragma once

#include <ompl/base/Planner.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "dismantle/sampling/nearest.h"
#include "dismantle/sampling/sampling_problem.h"

namespace dismantle::sampling {

/// RRT-Connect (Kuffner and LaValle 2000): one tree from the start, one from the goal (the problem's GoalState). In
/// each iteration one of them extends towards a random state, and the other goes on towards the new node until it gets
/// there or is blocked; then they change roles. The first random state is the other end itself.
///
/// Not ompl::geometric::RRTConnect: that draws its seeds from a sequence of the whole process. All random numbers
/// come from the generator given. solve() again starts with fresh trees and other numbers.
class ConnectTrees final : public ompl::base::Planner {
 public:
  using StateType = SamplingProblem::StateType;

  /// `range`: longest extension, assembly units.
  ConnectTrees(SamplingProblem& problem, double range, const Rng& rng);

  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& stop) override;
  void clear() override;

  /// From start to goal; empty before a solution was found.
  const std::vector<StateType>& solution() const { return solution_; }
  std::uint64_t nodes() const { return grown_ + trees_[0].nodes.size() + trees_[1].nodes.size(); }

 private:
  struct Node {
    StateType state;
    std::uint32_t parent = 0;
  };
  struct Tree {
    std::vector<Node> nodes;
    NearestNodes near;
    std::uint32_t add(const StateType& state, std::uint32_t parent);
    std::vector<StateType> to_root(std::uint32_t node) const;
  };
  std::uint32_t nearest(const Tree& tree, const StateType& state) const;
  /// Up to `range` towards the target, as far as it is free. Nothing: not a step.
  std::optional<std::uint32_t> extend(Tree& tree, std::uint32_t node, const StateType& target);
  void report(std::uint32_t in_first, std::uint32_t in_second);

  SamplingProblem& problem_;
  double range_;
  Rng rng_;
  Tree trees_[2];  // from the start, from the goal
  std::uint64_t grown_ = 0;
  std::vector<StateType> solution_;
};

}  // namespace dismantle::sampling
