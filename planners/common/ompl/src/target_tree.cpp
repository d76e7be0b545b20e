#include "dismantle/sampling/target_tree.h"

#include <ompl/base/PlannerData.h>
#include <ompl/geometric/PathGeometric.h>

#include <algorithm>
#include <cmath>

namespace dismantle::sampling {

namespace ob = ompl::base;

TargetTree::TargetTree(SamplingProblem& problem, const Settings& settings, std::unique_ptr<TargetRule> rule,
                       const Rng& rng)
    : Planner(problem.information(), "TargetTree"),
      problem_(problem),
      settings_(settings),
      rule_(std::move(rule)),
      rng_(rng) {}

void TargetTree::clear() {
  Planner::clear();
  nodes_.clear();
  near_ = {};
  solution_.clear();
  iterations_ = 0;
  farthest_ = 0;
}

std::uint32_t TargetTree::add(const StateType& state, std::uint32_t parent) {
  nodes_.push_back({state, parent});
  const std::uint32_t id = near_.add(state.center);
  const auto way = [&](std::uint32_t n) { return (nodes_[n].state.center - nodes_[0].state.center).squaredNorm(); };
  if (way(id) > way(farthest_)) farthest_ = id;
  return id;
}

std::uint32_t TargetTree::nearest(const StateType& state) const {
  const auto& space = problem_.space();
  return near_.nearest(state.center, [&](std::uint32_t n) { return space.distance(nodes_[n].state, state); });
}

void TargetTree::discard(std::uint32_t node) {
  near_.remove(node);
  for (std::uint32_t n = node + 1; n < nodes_.size(); ++n)  // children come after their parents
    if (near_.removed(nodes_[n].parent) && nodes_[n].parent >= node) near_.remove(n);
}

/// Returns the first new node that is out, if any.
std::optional<std::uint32_t> TargetTree::extend(std::uint32_t node, const StateType& target, bool greedy,
                                                const ob::PlannerTerminationCondition& stop) {
  const auto& space = problem_.space();
  while (true) {
    const StateType from = nodes_[node].state;
    const double way = space.distance(from, target);
    if (!(way > 0)) return std::nullopt;
    const bool last = way <= settings_.range;
    const StateType to = last ? target : space.between(from, target, settings_.range / way);
    const double share = problem_.free_share(from, to);
    if (share <= 0) return std::nullopt;
    node = add(share < 1 ? space.between(from, to, share) : to, node);
    if (getProblemDefinition()->getGoal()->isSatisfied(&nodes_[node].state)) return node;
    if (share < 1 || last || !greedy || stop()) return std::nullopt;
  }
}

void TargetTree::report(std::uint32_t node) {
  solution_.clear();
  for (std::uint32_t n = node; n != 0; n = nodes_[n].parent) solution_.push_back(n);
  solution_.push_back(0);
  std::reverse(solution_.begin(), solution_.end());
  auto path = std::make_shared<ompl::geometric::PathGeometric>(si_);
  for (const auto n : solution_) path->append(&nodes_[n].state);
  getProblemDefinition()->clearSolutionPaths();
  getProblemDefinition()->addSolutionPath(path, false, 0, getName());
}

ob::PlannerStatus TargetTree::solve(const ob::PlannerTerminationCondition& stop) {
  checkValidity();
  if (nodes_.empty()) {
    const ob::State* start = pis_.nextStart();
    if (start == nullptr) return ob::PlannerStatus::INVALID_START;
    add(*static_cast<const StateType*>(start), 0);
  }
  StateType drawn;
  while (!stop()) {
    // The first thing to try is a goal: many parts leave in a straight line.
    const bool to_goal = iterations_++ == 0 || rng_.uniform() < settings_.goal_bias;
    const auto target = to_goal ? rule_->target(*this, rng_) : std::nullopt;
    std::optional<std::uint32_t> out;
    if (target) {
      out = extend(target->node, target->state, true, stop);
    } else {
      problem_.space().draw(rng_, drawn);
      out = extend(nearest(drawn), drawn, false, stop);
    }
    if (out) {
      report(*out);
      return ob::PlannerStatus::EXACT_SOLUTION;
    }
  }
  return ob::PlannerStatus::TIMEOUT;
}

void TargetTree::getPlannerData(ob::PlannerData& data) const {
  Planner::getPlannerData(data);
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    if (near_.removed(n)) continue;
    if (n == 0)
      data.addStartVertex(ob::PlannerDataVertex(&nodes_[n].state));
    else
      data.addEdge(ob::PlannerDataVertex(&nodes_[nodes_[n].parent].state), ob::PlannerDataVertex(&nodes_[n].state));
  }
}

}  // namespace dismantle::sampling
