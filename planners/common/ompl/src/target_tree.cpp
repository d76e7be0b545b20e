#include "dismantle/ompl/target_tree.h"

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
      rng_(rng),
      tree_(problem.space()) {}

void TargetTree::clear() {
  Planner::clear();
  tree_.clear();
  solution_.clear();
  iterations_ = 0;
}

/// Returns the first new node that satisfies the goal, if any.
std::optional<std::uint32_t> TargetTree::extend(std::uint32_t node, const StateType& target, bool greedy,
                                                const ob::PlannerTerminationCondition& stop) {
  const auto& space = problem_.space();
  while (true) {
    const StateType from = tree_.state(node);
    const double distance = space.distance(from, target);
    if (!(distance > 0)) return std::nullopt;
    const bool last = distance <= settings_.range;
    const StateType to = last ? target : space.between(from, target, settings_.range / distance);
    const double share = problem_.free_share(from, to);
    if (share <= 0) return std::nullopt;
    node = tree_.add(share < 1 ? space.between(from, to, share) : to, node);
    if (getProblemDefinition()->getGoal()->isSatisfied(&tree_.state(node))) return node;
    if (share < 1 || last || !greedy || stop()) return std::nullopt;
  }
}

void TargetTree::report(std::uint32_t node) {
  solution_ = tree_.to_root(node);
  std::reverse(solution_.begin(), solution_.end());
  auto path = std::make_shared<ompl::geometric::PathGeometric>(si_);
  for (const auto n : solution_) path->append(&tree_.state(n));
  getProblemDefinition()->clearSolutionPaths();
  getProblemDefinition()->addSolutionPath(path, false, 0, getName());
}

ob::PlannerStatus TargetTree::solve(const ob::PlannerTerminationCondition& stop) {
  checkValidity();
  if (tree_.size() == 0) {
    const ob::State* start = pis_.nextStart();
    if (start == nullptr) return ob::PlannerStatus::INVALID_START;
    tree_.add_root(*static_cast<const StateType*>(start));
  }
  StateType drawn;
  while (!stop()) {
    // The first extension goes towards a goal, because many parts leave in a straight line.
    const bool to_goal = iterations_++ == 0 || rng_.uniform() < settings_.goal_bias;
    const auto target = to_goal ? rule_->target(*this, rng_) : std::nullopt;
    std::optional<std::uint32_t> out;
    if (target) {
      out = extend(target->node, target->state, true, stop);
    } else {
      problem_.space().draw(rng_, drawn);
      out = extend(tree_.nearest(drawn), drawn, false, stop);
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
  for (std::uint32_t n = 0; n < tree_.size(); ++n) {
    if (tree_.discarded(n)) continue;
    if (n == 0)
      data.addStartVertex(ob::PlannerDataVertex(&tree_.state(n)));
    else
      data.addEdge(ob::PlannerDataVertex(&tree_.state(tree_.parent(n))), ob::PlannerDataVertex(&tree_.state(n)));
  }
}

}  // namespace dismantle::sampling
