#include "dismantle/ompl/space_search.h"

#include <ompl/base/ProblemDefinition.h>

#include <algorithm>
#include <utility>

#include "dismantle/ompl/candidate_paths.h"
#include "dismantle/plugin/search_recorder.h"
#include "dismantle/search/ended_search.h"
#include "dismantle/search/growing_turns.h"
#include "dismantle/search/time_limit.h"

namespace dismantle::sampling {
namespace {

using StateType = SamplingProblem::StateType;

/// One state space and its planner.
class Space {
 public:
  Space(const PathQuery& query, MotionSpace motion, const SpaceParameters& p, const MakeSpacePlanner& make_planner,
        CheckBudget& budget, const Rng& rng)
      : problem_(query, motion, p.tolerance_share * query.tolerance, p.step, budget),
        planner_(make_planner(problem_, rng)) {}

  SamplingProblem& problem() { return problem_; }
  const SamplingProblem& problem() const { return problem_; }
  const SpacePlanner& planner() const { return *planner_; }

  /// Grows until a path is accepted, `limit` checks have been made in total, or the budget is spent.
  bool grow(CandidatePaths& candidates, std::uint64_t limit, PathResult& result) {
    const ompl::base::PlannerTerminationCondition stop(
        [&] { return problem_.budget().checks >= limit || problem_.budget().spent(); });
    while (true) {
      const std::vector<StateType> states = planner_->solve(stop);
      if (states.empty()) return false;
      std::size_t edge = 1;
      if (candidates.accepts(problem_, states, result, edge)) return true;
      planner_->discard(edge);
    }
  }

  /// Moves along each direction until separated or blocked.
  bool try_lines(const std::vector<Eigen::Vector3d>& directions, double range, CandidatePaths& candidates,
                 std::uint64_t limit, PathResult& result) {
    const StateType start = problem_.space().start();
    const double far = 2 * problem_.surroundings().bounds.size().norm();
    for (const auto& direction : directions) {
      if (problem_.budget().checks >= limit || problem_.budget().spent()) return false;
      ++lines_;
      StateType at = start;
      for (double length = 0; length < far;) {
        StateType next = at;
        next.center += range * direction;
        if (problem_.free_share(at, next) < 1) break;
        at = next;
        length += range;
        if (!problem_.is_separated(at)) continue;
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
  std::unique_ptr<SpacePlanner> planner_;
  std::uint64_t lines_ = 0;
};

class SpaceSearch final : public PathSearch {
 public:
  SpaceSearch(const PathQuery& query, RunContext& context, const SpaceParameters& parameters,
              const MakeSpacePlanner& make_planner, const MakeLines& make_lines)
      : query_(query),
        context_(context),
        parameters_(parameters),
        make_lines_(make_lines),
        budget_(query, context),
        level_(path::doubled_per_level(parameters.level_checks, query.budget.max_depth)),
        candidates_(query.checker, parameters.simplify),
        record_(query, context),
        turns_(parameters.motion == Motion::automatic ? 2 : 1, static_cast<std::uint64_t>(parameters.first_turn)) {
    const auto add = [&](MotionSpace motion, std::uint64_t stream) {
      spaces_.push_back(
          std::make_unique<Space>(query, motion, parameters, make_planner, budget_, context.rng.fork(stream)));
    };
    // A translation is a motion in SE(3) as well, so lines need no space of their own.
    if (parameters.motion != Motion::rotation) add(MotionSpace::translation, 1);
    if (parameters.motion != Motion::translation) add(MotionSpace::rigid, 2);
  }

  SearchStatus run(const Budget& portion) override {
    if (is_success(result_.outcome())) return SearchStatus::solved;
    const bool first = !begun_;
    begun_ = true;
    if (first && starts_separated()) {
      result_.start_is_goal();
      return SearchStatus::solved;
    }
    const std::uint64_t until = path::end_of_portion(budget_.checks, portion.max_steps, level_);
    const Deadline query_end = budget_.deadline;
    budget_.deadline = query_end.earlier(path::deadline_of(portion));
    bool solved = false;
    if (first && make_lines_)
      solved = spaces_.front()->try_lines(make_lines_(query_), parameters_.range, candidates_, level_, result_);
    if (!solved)
      turns_.run(
          until, [&] { return budget_.checks; },
          [&](std::size_t space, std::uint64_t share) {
            solved = spaces_[space]->grow(candidates_, share, result_);
            record(*spaces_[space]);
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
      double most = -1;
      for (const auto& space : spaces_) {
        const auto state = space->planner().farthest();
        if (!state) continue;
        const double distance = (state->center - space->problem().space().start().center).norm();
        if (distance > most) most = distance, result.best_pose = space->problem().poses(*state);
      }
      if (!context_.cancel.cancelled()) result.blocked_by = spaces_.front()->problem().blockers();
    }
    for (const auto& space : spaces_) {
      result.stats.nodes += space->planner().nodes();
      result.stats.extra["iterations"] += static_cast<double>(space->planner().iterations());
      if (make_lines_) result.stats.extra["lines"] += static_cast<double>(space->lines());
    }
    result.stats.state_checks = budget_.checks;
    result.stats.refused = candidates_.refused();
    result.stats.cost = static_cast<double>(budget_.checks);
    return result;
  }

 private:
  /// The best state of a tree; its other nodes are not recorded.
  void record(const Space& space) {
    const auto state = record_.listens() ? space.planner().farthest() : std::nullopt;
    if (!state) return;
    const double travel = (state->center - space.problem().space().start().center).norm();
    record_.node(-1, space.problem().poses(*state), static_cast<double>(budget_.checks), travel);
  }
  bool starts_separated() {
    SamplingProblem& first = spaces_.front()->problem();
    return first.is_separated(first.space().start());
  }

  const PathQuery& query_;
  RunContext& context_;
  const SpaceParameters parameters_;
  const MakeLines make_lines_;
  CheckBudget budget_;
  std::uint64_t level_;  ///< state checks that the depth limit allows
  CandidatePaths candidates_;
  SearchRecord record_;
  path::GrowingTurns turns_;
  std::vector<std::unique_ptr<Space>> spaces_;
  PathResult result_;
  bool begun_ = false;
};

}  // namespace

ompl::base::ProblemDefinitionPtr definition_of(SamplingProblem& problem, const ompl::base::GoalPtr& goal) {
  auto definition = std::make_shared<ompl::base::ProblemDefinition>(problem.information());
  const StateType start = problem.space().start();
  definition->addStartState(&start);
  definition->setGoal(goal);
  return definition;
}

std::unique_ptr<PathSearch> start_search(const PathQuery& query, RunContext& context, const SpaceParameters& parameters,
                                         const MakeSpacePlanner& make_planner, const MakeLines& make_lines) {
  const Capabilities has = query.simulator.capabilities();
  if (!has.distance || has.max_moving < query.scene.moving.size())
    return path::unsupported("needs a simulator with distance queries for all moving parts");
  return std::make_unique<SpaceSearch>(query, context, parameters, make_planner, make_lines);
}

}  // namespace dismantle::sampling
