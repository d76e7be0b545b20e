#include "dismantle/ompl/connect_trees.h"
#include "dismantle/ompl/start_and_goals.h"
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

class RrtConnectRemoval final : public PathPlanner {
 public:
  explicit RrtConnectRemoval(const Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override { return {.needs = sampling::kSpaceNeeds}; }
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    return sampling::start_search(
        query, context, parameters_, [p = parameters_](SamplingProblem& problem, const Rng& rng) {
          return std::make_unique<sampling::StartAndGoals<ConnectTrees>>(problem, p.goals, p.range, rng);
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
