/// A rapidly-exploring random tree as an OMPL planner with an exchangeable choice of goals.
#pragma once

#include <ompl/base/Planner.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/ompl/sampling_problem.h"
#include "dismantle/ompl/state_tree.h"

namespace dismantle::sampling {

class TargetTree;

/// Selects goals for extensions that do not go towards a random state.
class TargetRule {
 public:
  using StateType = SamplingProblem::StateType;
  struct Target {
    std::uint32_t node = 0;  ///< the node to extend
    StateType state;         ///< towards this state
  };
  virtual ~TargetRule() = default;
  /// Nothing if no goal is worth trying; the tree then extends towards a random state.
  virtual std::optional<Target> target(TargetTree& tree, Rng& rng) = 0;
};

/// LaValle 1998: in each iteration draw a state (or, with probability goal_bias, take a goal), and extend the nearest
/// node towards it. An extension is kept up to its first state that is not free. Towards a random state it is at most
/// `range` long; towards a goal it continues until it is blocked, with a node every `range`.
///
/// Ends as soon as a node satisfies the problem's goal. solve() may be called again and continues with the same tree.
/// All random numbers come from the generator given.
class TargetTree final : public ompl::base::Planner {
 public:
  using StateType = SamplingProblem::StateType;
  struct Settings {
    double goal_bias = 0.05;
    double range = 1;  ///< assembly units
  };

  TargetTree(SamplingProblem& problem, const Settings& settings, std::unique_ptr<TargetRule> rule, const Rng& rng);

  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& stop) override;
  void clear() override;
  void getPlannerData(ompl::base::PlannerData& data) const override;

  /// Nodes from the root to the node at which solve() ended; empty before.
  const std::vector<std::uint32_t>& solution() const { return solution_; }
  /// Removes a node other than the root, with its subtree.
  void discard(std::uint32_t node) { tree_.discard(node); }

  SamplingProblem& problem() { return problem_; }
  const StateType& state(std::uint32_t node) const { return tree_.state(node); }
  std::size_t size() const { return tree_.size(); }
  std::uint64_t iterations() const { return iterations_; }
  std::uint32_t nearest(const StateType& state) const { return tree_.nearest(state); }
  /// The node whose centre is furthest from the start.
  std::uint32_t farthest() const { return tree_.farthest(); }

 private:
  std::optional<std::uint32_t> extend(std::uint32_t node, const StateType& target, bool greedy,
                                      const ompl::base::PlannerTerminationCondition& stop);
  void report(std::uint32_t node);

  SamplingProblem& problem_;
  Settings settings_;
  std::unique_ptr<TargetRule> rule_;
  Rng rng_;
  StateTree tree_;
  std::uint64_t iterations_ = 0;
  std::vector<std::uint32_t> solution_;
};

}  // namespace dismantle::sampling
