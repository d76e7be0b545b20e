#include "dismantle/ompl/targetless.h"
#include "dismantle/ompl/tree_planner.h"
#include "dismantle/plugin.h"

namespace dismantle::t_rrt {
namespace {

struct Parameters : sampling::TreeParameters {
  Parameters() { goal_bias = 0.2; }
  static void describe(Schema<Parameters>& s) {
    sampling::describe_tree(s,
                            "Probability of extending a node towards the nearest state outside "
                            "the box of the rest (table 7).");
  }
};

class TargetlessRrt final : public PathPlanner {
 public:
  explicit TargetlessRrt(const Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override { return {.needs = sampling::kTreeNeeds}; }
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    return sampling::start_trees(query, context, parameters_, [](sampling::SamplingProblem& problem, Rng) {
      return std::make_unique<sampling::NearestExit>(problem);
    });
  }

 private:
  Parameters parameters_;
};

}  // namespace
}  // namespace dismantle::t_rrt

DISMANTLE_PLUGIN("dismantle.t_rrt", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::t_rrt::TargetlessRrt, dismantle::t_rrt::Parameters>(
      "t_rrt", "Targetless-RRT: a random tree whose goals are the nearest states outside the box of the rest.",
      {.source = "Aguinaga, Borro and Matey 2008; Tian et al. 2022, appendix C.1",
       .needs = dismantle::sampling::kTreeNeeds});
}
