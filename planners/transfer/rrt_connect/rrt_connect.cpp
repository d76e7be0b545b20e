#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/goals/GoalState.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "dismantle/path/candidates.h"
#include "dismantle/plugin.h"
#include "dismantle/sampling/candidate_paths.h"
#include "dismantle/sampling/connect_trees.h"
#include "straight.h"

namespace dismantle::rrt_connect {
namespace {

namespace ob = ompl::base;
using sampling::CheckBudget;
using sampling::ConnectTrees;
using sampling::SamplingProblem;

struct Parameters {
  bool straight_first = true;
  double clearance = 0.1;
  double range = 2;
  double step = 0.05;
  double tolerance_share = 0.4;
  bool simplify = true;
  std::int64_t max_checks = 30'000;
  int max_refused = 10;

  static void describe(Schema<Parameters>& s) {
    s.add("straight_first", &Parameters::straight_first,
          {.doc =
               "Before any tree is grown, try to lift the part, rotate it, carry it over everything and put it down."});
    s.add("clearance", &Parameters::clearance,
          {.unit = "unit", .min = 0, .doc = "Height above all other parts at which a part is carried over them."});
    s.add("range", &Parameters::range,
          {.unit = "unit", .min = 0, .min_open = true, .doc = "Longest extension of a tree."});
    s.add("step", &Parameters::step,
          {.unit = "unit",
           .min = 1e-5,
           .max = 1,
           .doc = "Distance between checked states of an extension: the largest displacement of any point of the part. "
                  "Smaller steps miss fewer thin obstacles and take more checks."});
    s.add("tolerance_share", &Parameters::tolerance_share,
          {.unit = "1",
           .min = 0,
           .max = 1,
           .doc = "Share of verify.max_penetration, above the initial overlap, at which a state counts as colliding."});
    s.add("simplify", &Parameters::simplify, {.doc = "Replace detours by straight motions where these are free."});
    s.add("max_checks", &Parameters::max_checks,
          {.unit = "1", .min = 0, .doc = "Most state checks for one transfer; 0 = only the limits of the run apply."});
    s.add(
        "max_refused", &Parameters::max_refused,
        {.unit = "1",
         .min = 1,
         .max = 1e6,
         .doc = "Paths of the trees that the verifier may refuse. Where simulator and verifier disagree, more paths of "
                "the same kind hardly help."});
  }
};

class RrtConnect final : public TransferPlanner {
 public:
  explicit RrtConnect(const Parameters& parameters) : parameters_(parameters) {}

  /// None: straight candidates need no simulator. Trees do, and say so.
  Capabilities needs() const noexcept override { return {}; }

  PathResult plan(const TransferQuery& query, RunContext& context) override {
    PathResult result;
    Pose goal;
    if (!displacement_to_goal(query, goal)) {
      result.fail(Outcome::unsupported, "the goal is not a rigid displacement of the group");
      return result;
    }
    if (parameters_.straight_first && goes_straight(query, context, result)) return result;
    const Capabilities has = query.simulator.capabilities();
    if (!has.distance || has.max_moving < query.scene.moving.size()) {
      result.fail(Outcome::unsupported,
                  "no straight path, and trees need a simulator with distance queries for all moving parts");
      return result;
    }
    grow(query, goal, context, result);
    return result;
  }

 private:
  bool goes_straight(const TransferQuery& query, RunContext& context, PathResult& result) {
    const StraightTransfers straight(query, parameters_.clearance, boxes_);
    std::uint64_t refused = 0;  // only what trees find counts in the statistics
    std::size_t instants = 0;
    return path::show_forms(
               query.checker, refused,
               [&](std::size_t k) -> std::optional<Path> {
                 if (context.should_stop()) return std::nullopt;
                 std::optional<Path> path = straight.path(k);
                 if (!path) return std::nullopt;
                 ++result.stats.extra["straight"];
                 instants = path->size();
                 return path;
               },
               [&](const PathCheck& check, const Path&) {
                 result.message = check.reason;
                 return true;
               },
               [&](VerifiedPath path) { result.solve(std::move(path), static_cast<unsigned>(instants - 1)); })
        .accepted;
  }

  void grow(const TransferQuery& query, const Pose& goal, RunContext& context, PathResult& result) const {
    PathQuery removal{query.assembly, query.simulator, query.prepared, query.scene,
                      query.budget,   query.tolerance, query.checker};
    const auto own = static_cast<std::uint64_t>(parameters_.max_checks);
    std::uint64_t& most = removal.budget.max_steps;
    if (own > 0) most = most > 0 ? std::min(most, own) : own;
    CheckBudget budget(removal, context);
    sampling::CandidatePaths candidates(query.checker, parameters_.simplify);

    // When start and goal have the same orientation, a quarter of the budget goes to a search among translations.
    const bool turns = angle_between(goal.q, Eigen::Quaterniond::Identity()) > 1e-9;
    result.fail(Outcome::timeout);
    for (const MotionSpace motion : {MotionSpace::translation, MotionSpace::rigid}) {
      if (motion == MotionSpace::translation && turns) continue;
      const std::uint64_t budgeted = most > 0 ? most : static_cast<std::uint64_t>(Parameters{}.max_checks);
      const std::uint64_t limit = motion == MotionSpace::rigid ? 0 : budgeted / 4;
      SamplingProblem problem(removal, motion, parameters_.tolerance_share * query.tolerance, parameters_.step, budget,
                              goal);
      ConnectTrees trees(problem, parameters_.range, context.rng.fork(motion == MotionSpace::translation ? 1 : 2));
      auto definition = std::make_shared<ob::ProblemDefinition>(problem.information());
      const auto start = problem.space().start();
      const auto end = problem.state_after(goal);
      definition->addStartState(&start);
      auto target = std::make_shared<ob::GoalState>(problem.information());
      target->setState(&end);
      definition->setGoal(target);
      trees.setProblemDefinition(definition);
      const ob::PlannerTerminationCondition stop(
          [&] { return budget.spent() || (limit > 0 && budget.checks >= limit); });
      ob::PlannerStatus status = ob::PlannerStatus::TIMEOUT;
      for (int shown = 0; shown < parameters_.max_refused && !stop(); ++shown) {
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

  Parameters parameters_;
  PartBoxes boxes_;
};

}  // namespace
}  // namespace dismantle::rrt_connect

DISMANTLE_PLUGIN("dismantle.rrt_connect", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::TransferPlanner, dismantle::rrt_connect::RrtConnect, dismantle::rrt_connect::Parameters>(
      "rrt_connect", "Straight over everything if that is free, else two trees that grow towards each other.",
      {.source = "Kuffner and LaValle 2000; Tian et al. 2022, section 4.4, Algorithm 3"});
}
