#include "dismantle/sampling/connect_trees.h"

#include <ompl/base/goals/GoalState.h>
#include <ompl/geometric/PathGeometric.h>

#include <algorithm>

namespace dismantle::sampling {

namespace ob = ompl::base;

std::uint32_t ConnectTrees::Tree::add(const StateType& state, std::uint32_t parent) {
  nodes.push_back({state, parent});
  return near.add(state.center);
}

std::vector<SamplingProblem::StateType> ConnectTrees::Tree::to_root(std::uint32_t node) const {
  std::vector<StateType> states;
  for (std::uint32_t n = node; n != 0; n = nodes[n].parent) states.push_back(nodes[n].state);
  states.push_back(nodes[0].state);
  return states;
}

ConnectTrees::ConnectTrees(SamplingProblem& problem, double range, const Rng& rng)
    : Planner(problem.information(), "ConnectTrees"), problem_(problem), range_(range), rng_(rng) {}

void ConnectTrees::clear() {
  Planner::clear();
  for (Tree& tree : trees_) {
    grown_ += tree.nodes.size();
    tree = {};
  }
  solution_.clear();
}

std::uint32_t ConnectTrees::nearest(const Tree& tree, const StateType& state) const {
  return tree.near.nearest(state.center,
                           [&](std::uint32_t n) { return problem_.space().distance(tree.nodes[n].state, state); });
}

std::optional<std::uint32_t> ConnectTrees::extend(Tree& tree, std::uint32_t node, const StateType& target) {
  const auto& space = problem_.space();
  const StateType from = tree.nodes[node].state;
  const double way = space.distance(from, target);
  if (!(way > 0)) return std::nullopt;
  const StateType to = way <= range_ ? target : space.between(from, target, range_ / way);
  const double share = problem_.free_share(from, to);
  if (share <= 0) return std::nullopt;
  return tree.add(share < 1 ? space.between(from, to, share) : to, node);
}

void ConnectTrees::report(std::uint32_t in_first, std::uint32_t in_second) {
  solution_ = trees_[0].to_root(in_first);
  std::reverse(solution_.begin(), solution_.end());
  const auto rest = trees_[1].to_root(in_second);  // begins with the state that ends the first
  solution_.insert(solution_.end(), rest.begin() + 1, rest.end());
  auto path = std::make_shared<ompl::geometric::PathGeometric>(si_);
  for (const auto& s : solution_) path->append(&s);
  getProblemDefinition()->clearSolutionPaths();
  getProblemDefinition()->addSolutionPath(path, false, 0, getName());
}

ob::PlannerStatus ConnectTrees::solve(const ob::PlannerTerminationCondition& stop) {
  checkValidity();
  clear();
  const auto* goal = dynamic_cast<const ob::GoalState*>(getProblemDefinition()->getGoal().get());
  if (goal == nullptr) return ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
  const auto start = *static_cast<const StateType*>(getProblemDefinition()->getStartState(0));
  const auto end = *static_cast<const StateType*>(goal->getState());
  if (!problem_.is_free(start)) return ob::PlannerStatus::INVALID_START;
  if (!problem_.is_free(end)) return ob::PlannerStatus::INVALID_GOAL;
  trees_[0].add(start, 0);
  trees_[1].add(end, 0);

  StateType target = end;
  for (int growing = 0; !stop(); growing = 1 - growing) {
    Tree& a = trees_[growing];
    Tree& b = trees_[1 - growing];
    if (const auto grown = extend(a, nearest(a, target), target)) {
      const StateType meeting = a.nodes[*grown].state;
      std::uint32_t at = nearest(b, meeting);
      while (!stop()) {
        const auto next = extend(b, at, meeting);
        if (!next) break;
        at = *next;
        if (problem_.space().distance(b.nodes[at].state, meeting) > 0) continue;
        growing == 0 ? report(*grown, at) : report(at, *grown);
        return ob::PlannerStatus::EXACT_SOLUTION;
      }
    }
    problem_.space().draw(rng_, target);
  }
  return ob::PlannerStatus::TIMEOUT;
}

}  // namespace dismantle::sampling
