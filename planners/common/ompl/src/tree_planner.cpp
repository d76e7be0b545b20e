#include "dismantle/ompl/tree_planner.h"

#include <ompl/base/ProblemDefinition.h>

namespace dismantle::sampling {
namespace {

class TreeInSpace final : public SpacePlanner {
 public:
  TreeInSpace(SamplingProblem& problem, const TreeParameters& p, const MakeRule& make_rule, const Rng& rng)
      : tree_(problem, {p.goal_bias, p.range}, make_rule(problem, rng.fork(1)), rng.fork(2)) {
    tree_.setProblemDefinition(definition_of(problem, std::make_shared<SeparatedGoal>(problem)));
  }

  std::vector<StateType> solve(const ompl::base::PlannerTerminationCondition& stop) override {
    std::vector<StateType> states;
    if (tree_.solve(stop) == ompl::base::PlannerStatus::EXACT_SOLUTION)
      for (const auto n : tree_.solution()) states.push_back(tree_.state(n));
    return states;
  }
  void discard(std::size_t edge) override { tree_.discard(tree_.solution()[edge]); }
  std::uint64_t nodes() const override { return tree_.size(); }
  std::uint64_t iterations() const override { return tree_.iterations(); }
  std::optional<StateType> farthest() const override {
    return tree_.size() > 0 ? std::optional(tree_.state(tree_.farthest())) : std::nullopt;
  }

 private:
  TargetTree tree_;
};

}  // namespace

std::unique_ptr<PathSearch> start_trees(const PathQuery& query, RunContext& context, const TreeParameters& parameters,
                                        const MakeRule& make_rule, const MakeLines& make_lines) {
  const auto make_tree = [parameters, make_rule](SamplingProblem& problem, const Rng& rng) {
    return std::make_unique<TreeInSpace>(problem, parameters, make_rule, rng);
  };
  return start_search(query, context, parameters, make_tree, make_lines);
}

}  // namespace dismantle::sampling
