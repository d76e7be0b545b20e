#include <set>

#include "dismantle/ompl/tree_planner.h"
#include "dismantle/plugin.h"

namespace dismantle::rrt {
namespace {

using sampling::SamplingProblem;
using sampling::TargetRule;
using sampling::TargetTree;

struct Parameters : sampling::TreeParameters {
  static void describe(Schema<Parameters>& s) {
    sampling::describe_tree(s, "Probability of extending towards the goal, one disassembled state drawn at random.");
  }
};

/// One goal for the whole search (section 6.1). The node nearest to the goal is extended towards it.
class OneGoal final : public TargetRule {
 public:
  OneGoal(SamplingProblem& problem, Rng rng) : goal_(problem.draw_disassembled(rng)) {}

  std::optional<Target> target(TargetTree& tree, Rng&) override {
    if (!goal_) return std::nullopt;
    const std::uint32_t node = tree.nearest(*goal_);
    // Repeating an extension would end at the same state.
    if (!tried_.insert(node).second) return std::nullopt;
    return Target{node, *goal_};
  }

 private:
  std::optional<StateType> goal_;
  std::set<std::uint32_t> tried_;
};

class Rrt final : public PathPlanner {
 public:
  explicit Rrt(const Parameters& parameters) : parameters_(parameters) {}
  PathPlannerTraits traits() const noexcept override { return {.needs = sampling::kTreeNeeds}; }
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) override {
    return sampling::start_trees(query, context, parameters_, [](SamplingProblem& problem, Rng rng) {
      return std::make_unique<OneGoal>(problem, rng);
    });
  }

 private:
  Parameters parameters_;
};

}  // namespace
}  // namespace dismantle::rrt

DISMANTLE_PLUGIN("dismantle.rrt", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::rrt::Rrt, dismantle::rrt::Parameters>(
      "rrt", "Rapidly-exploring random tree towards a disassembled state drawn at random.",
      {.source = "LaValle 1998; Tian et al. 2022, appendix C.1", .needs = dismantle::sampling::kTreeNeeds});
}
