#include "dismantle/ompl/connect_trees.h"

#include <ompl/base/goals/GoalState.h>
#include <ompl/geometric/PathGeometric.h>

#include <algorithm>

namespace dismantle::sampling {

namespace ob = ompl::base;

ConnectTrees::ConnectTrees(SamplingProblem& problem, double range, const Rng& rng)
    : Planner(problem.information(), "ConnectTrees"),
      problem_(problem),
      range_(range),
      rng_(rng),
      trees_{StateTree(problem.space()), StateTree(problem.space())} {}

void ConnectTrees::clear() {
  Planner::clear();
  for (StateTree& tree : trees_) {
    grown_ += tree.size();
    tree.clear();
  }
  growing_ = 0;
  connection_.reset();
  sampled_ = 0;
  solution_.clear();
}

std::optional<std::uint32_t> ConnectTrees::extend(StateTree& tree, std::uint32_t node, const StateType& target) {
  const auto& space = problem_.space();
  const StateType from = tree.state(node);
  const double distance = space.distance(from, target);
  if (!(distance > 0)) return std::nullopt;
  const StateType to = distance <= range_ ? target : space.between(from, target, range_ / distance);
  const double share = problem_.free_share(from, to);
  if (share <= 0) return std::nullopt;
  return tree.add(share < 1 ? space.between(from, to, share) : to, node);
}

void ConnectTrees::report(std::uint32_t in_first, std::optional<std::uint32_t> in_second) {
  child_of_edge_ = trees_[0].to_root(in_first);
  std::reverse(child_of_edge_.begin(), child_of_edge_.end());
  solution_.clear();
  for (const auto n : child_of_edge_) solution_.push_back(trees_[0].state(n));
  child_of_edge_.erase(child_of_edge_.begin());  // the root ends no edge
  edges_of_first_ = child_of_edge_.size();
  if (in_second) {
    auto rest = trees_[1].to_root(*in_second);  // begins with the state at which the first tree's branch ends
    for (auto n = rest.begin() + 1; n != rest.end(); ++n) solution_.push_back(trees_[1].state(*n));
    rest.pop_back();
    child_of_edge_.insert(child_of_edge_.end(), rest.begin(), rest.end());
  }
  auto path = std::make_shared<ompl::geometric::PathGeometric>(si_);
  for (const auto& s : solution_) path->append(&s);
  getProblemDefinition()->clearSolutionPaths();
  getProblemDefinition()->addSolutionPath(path, false, 0, getName());
}

void ConnectTrees::discard(std::size_t edge) {
  trees_[edge <= edges_of_first_ ? 0 : 1].discard(child_of_edge_.at(edge - 1));
  solution_.clear();
  next_iteration();
}

void ConnectTrees::add_root(const ob::GoalSampleableRegion& goal) {
  if (sampled_ >= goal.maxSampleCount()) return;
  ++sampled_;
  StateType root;
  goal.sampleGoal(&root);
  if (!problem_.is_free(root)) return;
  trees_[1].add_root(root);
  growing_ = 0;
  target_ = root;
}

void ConnectTrees::next_iteration() {
  connection_.reset();
  growing_ = 1 - growing_;
  problem_.space().draw(rng_, target_);
}

ob::PlannerStatus ConnectTrees::solve(const ob::PlannerTerminationCondition& stop) {
  checkValidity();
  const auto* goal = dynamic_cast<const ob::GoalSampleableRegion*>(getProblemDefinition()->getGoal().get());
  if (goal == nullptr) return ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
  // A single goal state is reached only where the trees meet, a region at any state in it.
  const bool is_region = dynamic_cast<const ob::GoalState*>(goal) == nullptr;
  if (trees_[0].size() == 0) {
    const auto start = *static_cast<const StateType*>(getProblemDefinition()->getStartState(0));
    if (!problem_.is_free(start)) return ob::PlannerStatus::INVALID_START;
    trees_[0].add_root(start);
  }
  while (!stop()) {
    if (!connection_) {
      ++iterations_;
      add_root(*goal);
      if (trees_[1].size() == 0) return ob::PlannerStatus::INVALID_GOAL;
      StateTree& a = trees_[growing_];
      const auto grown = extend(a, a.nearest(target_), target_);
      if (!grown) {
        next_iteration();
        continue;
      }
      if (growing_ == 0 && is_region && goal->isSatisfied(&a.state(*grown))) {
        report(*grown, std::nullopt);
        return ob::PlannerStatus::EXACT_SOLUTION;
      }
      connection_ = {*grown, trees_[1 - growing_].nearest(a.state(*grown))};
      continue;
    }
    StateTree& b = trees_[1 - growing_];
    const StateType meeting = trees_[growing_].state(connection_->meeting);
    const auto next = extend(b, connection_->at, meeting);
    if (!next) {
      next_iteration();
      continue;
    }
    connection_->at = *next;
    const bool met = !(problem_.space().distance(b.state(*next), meeting) > 0);
    const bool out = !met && growing_ == 1 && is_region && goal->isSatisfied(&b.state(*next));
    if (!met && !out) continue;
    if (out)
      report(*next, std::nullopt);
    else if (growing_ == 0)
      report(connection_->meeting, *next);
    else
      report(*next, connection_->meeting);
    return ob::PlannerStatus::EXACT_SOLUTION;
  }
  return ob::PlannerStatus::TIMEOUT;
}

}  // namespace dismantle::sampling
