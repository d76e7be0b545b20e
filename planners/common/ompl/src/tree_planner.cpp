#include "dismantle/sampling/tree_planner.h"

#include <ompl/base/ProblemDefinition.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "dismantle/path/candidates.h"
#include "dismantle/path/ended_search.h"
#include "dismantle/path/growing_turns.h"

namespace dismantle::sampling {
namespace {

using StateType = SamplingProblem::StateType;

/// Checks of the first turn of a tree where two grow in turn; each round doubles it.
constexpr std::uint64_t kFirstTurn = 4'000;

/// Shows a path to the checker, simplified and then as it is.
class Candidates {
 public:
  Candidates(const PathChecker& checker, bool simplify) : checker_(checker), simplify_(simplify) {}

  /// True: `result` holds the path. False: `edge` is that of `states` which is at fault.
  bool accepts(SamplingProblem& problem, const std::vector<StateType>& states, PathResult& result, std::size_t& edge) {
    std::vector<std::vector<StateType>> forms;
    if (simplify_ && states.size() > 2) {
      forms.push_back(problem.shortcut(states));
      if (forms.back().size() >= states.size()) forms.clear();
    }
    forms.push_back(states);
    std::vector<std::size_t> edge_of;
    std::size_t shown = 0;
    return path::show_forms(
               checker_, refused_,
               [&](std::size_t k) -> std::optional<Path> {
                 shown = k;
                 return k < forms.size() ? std::optional(problem.path(forms[k], &edge_of)) : std::nullopt;
               },
               [&](const PathCheck& check, const Path&) {
                 result.message = check.reason;
                 // The instant is the last one before the fault: the edge that
                 // follows is to blame. Without a place, the last.
                 edge = check.has_witness ? edge_of[std::min(check.instant + 1, edge_of.size() - 1)]
                                          : forms[shown].size() - 1;
                 edge = std::max<std::size_t>(edge, 1);
                 return true;
               },
               [&](VerifiedPath path) {
                 result.solve(std::move(path), static_cast<unsigned>(forms[shown].size() - 1));
               })
        .accepted;
  }
  std::uint64_t refused() const { return refused_; }

 private:
  const PathChecker& checker_;
  bool simplify_;
  std::uint64_t refused_ = 0;
};

/// One tree in one state space.
class Tree {
 public:
  Tree(const PathQuery& query, MotionSpace motion, const TreeParameters& p, const MakeRule& make_rule,
       CheckBudget& budget, const Rng& rng)
      : problem_(query, motion, p.tolerance_share * query.tolerance, p.step, budget),
        tree_(problem_, {p.goal_bias, p.range}, make_rule(problem_, rng.fork(1)), rng.fork(2)) {
    auto problem = std::make_shared<ompl::base::ProblemDefinition>(problem_.information());
    const StateType start = problem_.space().start();
    problem->addStartState(&start);
    problem->setGoal(std::make_shared<SeparatedGoal>(problem_));
    tree_.setProblemDefinition(problem);
  }

  SamplingProblem& problem() { return problem_; }
  const SamplingProblem& problem() const { return problem_; }
  const TargetTree& tree() const { return tree_; }

  /// Until a path is accepted, or `limit` checks have been made in all, or the
  /// budget is spent.
  bool grow(Candidates& candidates, std::uint64_t limit, PathResult& result) {
    const ompl::base::PlannerTerminationCondition stop(
        [&] { return problem_.budget().checks >= limit || problem_.budget().spent(); });
    while (tree_.solve(stop) == ompl::base::PlannerStatus::EXACT_SOLUTION) {
      std::vector<StateType> states;
      for (const auto n : tree_.solution()) states.push_back(tree_.state(n));
      std::size_t edge = 1;
      if (candidates.accepts(problem_, states, result, edge)) return true;
      tree_.discard(tree_.solution()[edge]);
    }
    return false;
  }

  /// Straight on along each direction until out or blocked.
  bool try_lines(const std::vector<Eigen::Vector3d>& directions, double range, Candidates& candidates,
                 std::uint64_t limit, PathResult& result) {
    const StateType start = problem_.space().start();
    const double far = 2 * problem_.surroundings().bounds.size().norm();
    for (const auto& direction : directions) {
      if (problem_.budget().checks >= limit || problem_.budget().spent()) return false;
      ++lines_;
      StateType at = start;
      for (double way = 0; way < far;) {
        StateType next = at;
        next.center += range * direction;
        if (problem_.free_share(at, next) < 1) break;
        at = next;
        way += range;
        if (!problem_.is_out(at)) continue;
        std::size_t edge = 1;
        if (candidates.accepts(problem_, {start, at}, result, edge)) return true;
        break;
      }
    }
    return false;
  }
  std::uint64_t lines() const { return lines_; }

 private:
  SamplingProblem problem_;
  TargetTree tree_;
  std::uint64_t lines_ = 0;
};

class TreesSearch final : public PathSearch {
 public:
  TreesSearch(const PathQuery& query, RunContext& context, const TreeParameters& parameters, const MakeRule& make_rule,
              const MakeLines& make_lines)
      : query_(query),
        context_(context),
        parameters_(parameters),
        make_lines_(make_lines),
        budget_(query, context),
        level_(path::doubled_per_level(parameters.level_checks, query.budget.max_depth)),
        candidates_(query.checker, parameters.simplify),
        turns_(parameters.motion == Motion::automatic ? 2 : 1, kFirstTurn) {
    const auto add = [&](MotionSpace motion, std::uint64_t stream) {
      trees_.push_back(std::make_unique<Tree>(query, motion, parameters, make_rule, budget_, context.rng.fork(stream)));
    };
    // A motion without turns is a motion in SE(3), too: lines need no space of
    // their own.
    if (parameters.motion != Motion::rotation) add(MotionSpace::translation, 1);
    if (parameters.motion != Motion::translation) add(MotionSpace::rigid, 2);
  }

  SearchStatus run(const Budget& portion) override {
    if (is_success(result_.outcome())) return SearchStatus::solved;
    const bool first = !begun_;
    begun_ = true;
    if (first && starts_out()) {
      result_.start_is_goal();
      return SearchStatus::solved;
    }
    const std::uint64_t until = path::end_of_portion(budget_.checks, portion.max_steps, level_);
    const Deadline query_end = budget_.deadline;
    if (portion.timeout > 0) budget_.deadline = query_end.earlier(Deadline::after_seconds(portion.timeout));
    bool solved = false;
    if (first && make_lines_)
      solved = trees_.front()->try_lines(make_lines_(query_), parameters_.range, candidates_, level_, result_);
    if (!solved)
      turns_.run(
          until, [&] { return budget_.checks; },
          [&](std::size_t tree, std::uint64_t share) {
            solved = trees_[tree]->grow(candidates_, share, result_);
            return solved || budget_.spent();
          });
    budget_.deadline = query_end;
    if (solved) return SearchStatus::solved;
    result_.fail(budget_.spent() ? budget_.why() : Outcome::depth_limit);
    if (budget_.spent() || budget_.checks >= level_) return status_of(result_.outcome());
    return SearchStatus::paused;
  }

  PathResult result() override {
    PathResult result = result_;
    if (!is_success(result.outcome())) {
      const Tree* furthest = nullptr;
      double most = -1;
      for (const auto& t : trees_) {
        const TargetTree& tree = t->tree();
        if (tree.size() == 0) continue;
        const double way = (tree.state(tree.farthest()).center - tree.state(0).center).norm();
        if (way > most) most = way, furthest = t.get();
      }
      if (furthest != nullptr)
        result.best_pose = furthest->problem().poses(furthest->tree().state(furthest->tree().farthest()));
      if (!context_.cancel.cancelled()) result.blocked_by = trees_.front()->problem().blockers();
    }
    for (const auto& tree : trees_) {
      result.stats.nodes += tree->tree().size();
      result.stats.extra["iterations"] += static_cast<double>(tree->tree().iterations());
      if (make_lines_) result.stats.extra["lines"] += static_cast<double>(tree->lines());
    }
    result.stats.state_checks = budget_.checks;
    result.stats.refused = candidates_.refused();
    result.stats.cost = static_cast<double>(budget_.checks);
    return result;
  }

 private:
  bool starts_out() {
    SamplingProblem& first = trees_.front()->problem();
    return first.is_out(first.space().start());
  }

  const PathQuery& query_;
  RunContext& context_;
  const TreeParameters parameters_;
  const MakeLines make_lines_;
  CheckBudget budget_;
  std::uint64_t level_;  ///< state checks that the depth limit allows
  Candidates candidates_;
  path::GrowingTurns turns_;
  std::vector<std::unique_ptr<Tree>> trees_;
  PathResult result_;
  bool begun_ = false;
};

}  // namespace

std::unique_ptr<PathSearch> start_trees(const PathQuery& query, RunContext& context, const TreeParameters& parameters,
                                        const MakeRule& make_rule, const MakeLines& make_lines) {
  const Capabilities has = query.simulator.capabilities();
  if (!has.distance || has.max_moving < query.scene.moving.size())
    return path::unsupported("needs a simulator with distance queries for all moving parts");
  return std::make_unique<TreesSearch>(query, context, parameters, make_rule, make_lines);
}

}  // namespace dismantle::sampling
