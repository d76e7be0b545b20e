#include "trees.h"

#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/goals/GoalState.h>

#include <algorithm>
#include <utility>

#include "dismantle/ompl/candidate_paths.h"
#include "dismantle/ompl/connect_trees.h"

namespace dismantle::rrt_connect {
namespace {

namespace ob = ompl::base;
using sampling::CheckBudget;
using sampling::ConnectTrees;
using sampling::SamplingProblem;

void grow(const Parameters& parameters, const TransferQuery& query, const Pose& goal, RunContext& context,
          PathResult& result) {
  PathQuery removal{query.assembly, query.simulator, query.prepared, query.scene,
                    query.budget,   query.tolerance, query.checker};
  const auto own = static_cast<std::uint64_t>(parameters.max_checks);
  std::uint64_t& most = removal.budget.max_steps;
  if (own > 0) most = most > 0 ? std::min(most, own) : own;
  CheckBudget budget(removal, context);
  sampling::CandidatePaths candidates(query.checker, parameters.simplify);

  // When start and goal have the same orientation, a quarter of the budget goes to a search among translations.
  const bool turns = angle_between(goal.q, Eigen::Quaterniond::Identity()) > 1e-9;
  result.fail(Outcome::timeout);
  for (const MotionSpace motion : {MotionSpace::translation, MotionSpace::rigid}) {
    if (motion == MotionSpace::translation && turns) continue;
    const std::uint64_t budgeted = most > 0 ? most : static_cast<std::uint64_t>(Parameters{}.max_checks);
    const std::uint64_t limit = motion == MotionSpace::rigid ? 0 : budgeted / 4;
    SamplingProblem problem(removal, motion, parameters.tolerance_share * query.tolerance, parameters.step, budget,
                            goal);
    ConnectTrees trees(problem, parameters.range, context.rng.fork(motion == MotionSpace::translation ? 1 : 2));
    auto definition = std::make_shared<ob::ProblemDefinition>(problem.information());
    const auto start = problem.space().start();
    const auto end = problem.state_after(goal);
    definition->addStartState(&start);
    auto target = std::make_shared<ob::GoalState>(problem.information());
    target->setState(&end);
    definition->setGoal(target);
    trees.setProblemDefinition(definition);
    const ob::PlannerTerminationCondition stop([&] { return budget.spent() || (limit > 0 && budget.checks >= limit); });
    ob::PlannerStatus status = ob::PlannerStatus::TIMEOUT;
    for (int shown = 0; shown < parameters.max_refused && !stop(); ++shown) {
      status = trees.solve(stop);
      if (status != ob::PlannerStatus::EXACT_SOLUTION) break;
      std::size_t edge = 0;  // not used: both trees begin anew
      if (candidates.accepts(problem, trees.solution(), result, edge, query.goal)) break;
      trees.clear();
    }
    result.stats.nodes += trees.nodes();
    if (result.outcome() == Outcome::solved) {
      result.blocked_by.clear();
      break;
    }
    result.blocked_by = problem.blockers();
    if (status == ob::PlannerStatus::INVALID_START || status == ob::PlannerStatus::INVALID_GOAL) {
      result.fail(Outcome::invalid_start, status == ob::PlannerStatus::INVALID_START
                                              ? "the part collides where it lies in the layout"
                                              : "the part collides where it is to be put in");
      break;
    }
  }
  if (result.outcome() == Outcome::timeout && context.cancel.cancelled()) result.fail(Outcome::cancelled);
  result.stats.refused = candidates.refused();
  result.stats.state_checks = budget.checks;
  result.stats.cost = static_cast<double>(budget.checks);
}

}  // namespace
}  // namespace dismantle::rrt_connect

void dismantle_connect_by_trees(const dismantle::rrt_connect::Parameters& parameters,
                                const dismantle::TransferQuery& query, const dismantle::Pose& goal,
                                dismantle::RunContext& context, dismantle::PathResult& result) {
  dismantle::rrt_connect::grow(parameters, query, goal, context, result);
}
