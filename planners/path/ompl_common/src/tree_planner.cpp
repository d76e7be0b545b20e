#include "dismantle/sampling/tree_planner.h"

#include <ompl/base/ProblemDefinition.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dismantle::sampling {
namespace {

using StateType = Scene::StateType;

/// Checks of the first turn of a tree where two grow in turn; each round doubles it.
constexpr std::uint64_t kFirstTurn = 4'000;

/// Shows a path to the judge.
class Court {
 public:
  Court(const PathQuery& query, bool simplify) : query_(query), simplify_(simplify) {}

  /// True: `result` holds the path. False: `edge` is that of `states` which is at fault.
  bool accepts(Scene& scene, const std::vector<StateType>& states, PathResult& result, std::size_t& edge) {
    if (simplify_ && states.size() > 2) {
      const auto shorter = scene.shortcut(states);
      if (shorter.size() < states.size() && shown(scene, shorter, result, edge)) return true;
    }
    return shown(scene, states, result, edge);
  }
  std::uint64_t refused() const { return refused_; }

 private:
  bool shown(Scene& scene, const std::vector<StateType>& states, PathResult& result, std::size_t& edge) {
    std::vector<std::size_t> edge_of;
    PathCheck check = query_.checker.check(scene.path(states, &edge_of));
    if (check.accepted()) {
      result.solve(std::move(*check.verified), static_cast<unsigned>(states.size() - 1));
      return true;
    }
    ++refused_;
    result.message = check.reason;
    // The instant is the last one before the fault: the edge that follows is to blame. Without a place, the last.
    edge = check.has_witness ? edge_of[std::min(check.instant + 1, edge_of.size() - 1)] : states.size() - 1;
    edge = std::max<std::size_t>(edge, 1);
    return false;
  }

  const PathQuery& query_;
  bool simplify_;
  std::uint64_t refused_ = 0;
};

/// One tree in one state space.
class Search {
 public:
  Search(const PathQuery& query, MotionSpace motion, const TreeParameters& p, const MakeRule& make_rule,
         CheckBudget& budget, const Rng& rng)
      : scene_(query, motion, p.tolerance_share * query.tolerance, p.step, budget),
        tree_(scene_, {p.goal_bias, p.range}, make_rule(scene_, rng.fork(1)), rng.fork(2)) {
    auto problem = std::make_shared<ompl::base::ProblemDefinition>(scene_.information());
    const StateType start = scene_.space().start();
    problem->addStartState(&start);
    problem->setGoal(std::make_shared<SeparatedGoal>(scene_));
    tree_.setProblemDefinition(problem);
  }

  Scene& scene() { return scene_; }
  const TargetTree& tree() const { return tree_; }

  /// Until a path is accepted, or `limit` checks have been made in all, or the budget is spent.
  bool grow(Court& court, std::uint64_t limit, PathResult& result) {
    const ompl::base::PlannerTerminationCondition stop(
        [&] { return scene_.budget().checks >= limit || scene_.budget().spent(); });
    while (tree_.solve(stop) == ompl::base::PlannerStatus::EXACT_SOLUTION) {
      std::vector<StateType> states;
      for (const auto n : tree_.solution()) states.push_back(tree_.state(n));
      std::size_t edge = 1;
      if (court.accepts(scene_, states, result, edge)) return true;
      tree_.discard(tree_.solution()[edge]);
    }
    return false;
  }

  /// Straight on along each direction until out or blocked.
  bool try_lines(const std::vector<Eigen::Vector3d>& directions, double range, Court& court, std::uint64_t limit,
                 PathResult& result) {
    const StateType start = scene_.space().start();
    const double far = 2 * scene_.surroundings().bounds.size().norm();
    for (const auto& direction : directions) {
      if (scene_.budget().checks >= limit || scene_.budget().spent()) return false;
      ++lines_;
      StateType at = start;
      for (double way = 0; way < far;) {
        StateType next = at;
        next.center += range * direction;
        if (scene_.free_share(at, next) < 1) break;
        at = next;
        way += range;
        if (!scene_.is_out(at)) continue;
        std::size_t edge = 1;
        if (court.accepts(scene_, {start, at}, result, edge)) return true;
        break;
      }
    }
    return false;
  }
  std::uint64_t lines() const { return lines_; }

 private:
  Scene scene_;
  TargetTree tree_;
  std::uint64_t lines_ = 0;
};

/// Checks that a limit of depth allows; 0 = no limit.
std::uint64_t level_limit(const dismantle::Budget& effort, const TreeParameters& p) {
  if (effort.max_depth == 0) return 0;
  const double checks =
      std::ldexp(static_cast<double>(p.level_checks), static_cast<int>(std::min(effort.max_depth, 60u)) - 1);
  return checks < 1e18 ? static_cast<std::uint64_t>(checks) : 0;
}

}  // namespace

PathResult plan_by_trees(const PathQuery& query, RunContext& context, const TreeParameters& parameters,
                         const MakeRule& make_rule, const MakeLines& make_lines) {
  PathResult result;
  const Capabilities has = query.simulator.capabilities();
  if (!has.distance || has.max_moving < query.cast.moving.size()) {
    result.fail(Outcome::unsupported, "needs a simulator with distance queries for all moving parts");
    return result;
  }
  CheckBudget budget(query, context);
  const std::uint64_t level = level_limit(query.budget, parameters);
  const std::uint64_t limit = level > 0 ? level : std::numeric_limits<std::uint64_t>::max();
  Court court(query, parameters.simplify);

  std::vector<std::unique_ptr<Search>> searches;
  const auto add = [&](MotionSpace motion, std::uint64_t stream) {
    searches.push_back(
        std::make_unique<Search>(query, motion, parameters, make_rule, budget, context.rng.fork(stream)));
  };
  // A motion without turns is a motion in SE(3), too: lines need no space of their own.
  if (parameters.motion != Motion::rotation) add(MotionSpace::translation, 1);
  if (parameters.motion != Motion::translation) add(MotionSpace::rigid, 2);

  Scene& first = searches.front()->scene();
  if (first.is_out(first.space().start())) {
    result.start_is_goal();
    return result;
  }

  bool solved = false;
  if (make_lines) solved = searches.front()->try_lines(make_lines(query), parameters.range, court, limit, result);
  for (std::uint64_t turn = kFirstTurn; !solved && budget.checks < limit && !budget.spent(); turn *= 2)
    for (const auto& search : searches) {
      const std::uint64_t share = searches.size() > 1 ? std::min(limit, budget.checks + turn) : limit;
      if (solved = search->grow(court, share, result); solved) break;
    }

  if (!solved) {
    result.fail(budget.spent() ? budget.why() : Outcome::depth_limit);
    std::size_t furthest = 0;
    double most = -1;
    for (std::size_t i = 0; i < searches.size(); ++i) {
      const auto& tree = searches[i]->tree();
      if (tree.size() == 0) continue;
      const double way = (tree.state(tree.farthest()).center - tree.state(0).center).norm();
      if (way > most) most = way, furthest = i;
    }
    if (most >= 0)
      result.best_pose =
          searches[furthest]->scene().poses(searches[furthest]->tree().state(searches[furthest]->tree().farthest()));
    if (!context.cancel.cancelled()) result.blocked_by = searches.front()->scene().blockers();
  }
  for (const auto& search : searches) {
    result.stats.nodes += search->tree().size();
    result.stats.extra["iterations"] += static_cast<double>(search->tree().iterations());
    if (make_lines) result.stats.extra["lines"] += static_cast<double>(search->lines());
  }
  result.stats.state_checks = budget.checks;
  result.stats.refused = court.refused();
  result.stats.cost = static_cast<double>(budget.checks);
  std::string text = "trees:";
  for (const auto& [name, count] : result.stats.by_name())
    text += " " + name + " " + std::to_string(static_cast<std::uint64_t>(count));
  context.log(LogLevel::debug, text);
  return result;
}

}  // namespace dismantle::sampling
