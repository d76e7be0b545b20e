#include "dismantle/ompl/connect_trees.h"
#include "dismantle/ompl/disassembled_goal.h"
#include "dismantle/ompl/space_search.h"
#include "dismantle/plugin.h"

namespace dismantle::rrt_connect_removal {
namespace {

using sampling::ConnectTrees;
using sampling::SamplingProblem;

struct Parameters : sampling::SpaceParameters {
  std::int64_t goals = 20;

  static void describe(Schema<Parameters>& s) {
    sampling::describe_motion(s);
    s.add("goals", &Parameters::goals,
          {.unit = "1",
           .min = 1,
           .max = 1e6,
           .doc = "Disassembled states that the second tree grows from: the six nearest exits, then random "
                  "states."});
    sampling::describe_space(s, "Longest extension of a tree.");
  }
};

class TwoTreesInSpace final : public sampling::SpacePlanner {
 public:
  TwoTreesInSpace(SamplingProblem& problem, const Parameters& p, const Rng& rng)
      : trees_(problem, p.range, rng.fork(1)) {
    trees_.setProblemDefinition(sampling::definition_of(
        problem, std::make_shared<sampling::DisassembledGoal>(problem, static_cast<unsigned>(p.goals), rng.fork(2))));
  }

  std::vector<StateType> solve(const ompl::base::PlannerTerminationCondition& stop) override {
    return trees_.solve(stop) == ompl::base::PlannerStatus::EXACT_SOLUTION ? trees_.solution()
                                                                           : std::vector<StateType>{};
  }
  void discard(std::size_t edge) override { trees_.discard(edge); }
  std::uint64_t nodes() const override { return trees_.nodes(); }
  std::uint64_t iterations() const override { return trees_.iterations(); }
  std::optional<StateType> farthest() const override {
    const sampling::StateTree& tree = trees_.from_start();
    return tree.size() > 0 ? std::optional(tree.state(tree.farthest())) : std::nullopt;
  }

 private:
  ConnectTrees trees_;
};

class RrtConnectRemoval final : public PathPlanner {
 public:
  explicit RrtConnectRemoval(const Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override { return {.needs = sampling::kSpaceNeeds}; }
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    return sampling::start_search(query, context, parameters_,
                                  [p = parameters_](SamplingProblem& problem, const Rng& rng) {
                                    return std::make_unique<TwoTreesInSpace>(problem, p, rng);
                                  });
  }

 private:
  Parameters parameters_;
};

}  // namespace
}  // namespace dismantle::rrt_connect_removal

DISMANTLE_PLUGIN("dismantle.rrt_connect_removal", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::rrt_connect_removal::RrtConnectRemoval,
        dismantle::rrt_connect_removal::Parameters>(
      "rrt_connect_removal", "RRT-Connect: a tree from the start and one from disassembled states.",
      {.source = "Kuffner and LaValle 2000", .needs = dismantle::sampling::kSpaceNeeds});
}
