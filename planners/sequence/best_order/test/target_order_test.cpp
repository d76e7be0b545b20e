// The steps to one part, compared with all orders of blocks on a lattice, which a search of its own finds.
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "best_order/best_order.h"
#include "dismantle/testing/built_in_provers.h"
#include "dismantle/testing/lattice.h"
#include "dismantle/testing/run_rig.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {
namespace {

/// Each step costs 1; with `turns`, less than that for a change of the direction.
class Counts final : public StepCheck {
 public:
  explicit Counts(double turns = 0) : turns_(turns) {}
  StepCheckTraits traits() const noexcept override {
    return {.remembers_direction = turns_ > 0, .reads_present = false, .reads_path = false};
  }
  StepVerdict judge(const StepQuestion& q, const RunContext&) const override {
    StepVerdict verdict;
    verdict.cost = 1;
    if (turns_ > 0 && q.previous != nullptr && q.previous->direction.dot(q.direction) < 0.9) verdict.cost += turns_;
    return verdict;
  }

 private:
  double turns_;
};

Objective counted(double turns = 0) { return {{{"counts", std::make_shared<Counts>(turns), 1, false}}}; }

/// Finds nothing.
class Idle final : public SequencePlanner {
 public:
  SequencePlannerTraits traits() const noexcept override { return {.keeps_constraints = true, .any_start = true}; }
  SequenceResult plan(const SequenceQuery& query, PathOracle&, SequenceObserver&, RunContext&) override {
    SequenceResult result;
    result.outcome = Outcome::exhausted;
    result.remaining = ids_of(query.start.front());
    return result;
  }
};

/// `inner`: a planner of the registry; empty: one that finds nothing.
RunResult plan_to(PartId target, const Assembly& assembly, const Objective& objective, const std::string& inner,
                  double effort, Constraints constraints = {}) {
  BestOrderParameters params;
  params.effort = effort;
  params.of = {PluginChoice{"inner", {}, {}}, [inner](PluginKind, const PluginChoice&) -> std::shared_ptr<void> {
                 if (inner.empty()) return std::make_shared<Idle>();
                 return fake::plugin_registry().create<SequencePlanner>(inner);
               }};
  PlanningSetup setup = fake::setup(fake::push, std::make_shared<BestOrder>(params));
  setup.objective = objective;
  RunOptions options;
  options.constraints = std::move(constraints);
  options.constraints.target = target;
  RunContext context;
  RunResult result = run(assembly, setup, options, context);
  const PlanCheck check = check_plan(result.plan, assembly, options.verify, context, {});
  EXPECT_TRUE(check.valid) << (check.problems.empty() ? "" : check.problems.front().message);
  return result;
}

TEST(TargetOrder, HasTheFewestStepsOfAllOrdersOfBlocksOnALattice) {
  Rng rng(54);
  std::map<unsigned, unsigned> by_depth;
  unsigned never = 0, improved = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const fake::Lattice lattice = fake::Lattice::random(rng, trial % 3 == 1, trial % 5 != 0);
    // As a rule, a part that is hard to reach.
    PartId target = static_cast<PartId>(rng.below(lattice.parts));
    for (PartId other = 0; other < lattice.parts && trial % 4 != 0; ++other)
      if (lattice.fewest_steps(other) > lattice.fewest_steps(target)) target = other;
    const auto truth = lattice.fewest_steps(target);
    const Assembly assembly = lattice.assembly();
    const RunResult found = plan_to(target, assembly, counted(), "", 1e5, lattice.constraints);
    if (!truth) {
      ++never;
      EXPECT_EQ(found.outcome, Outcome::exhausted) << trial;
      EXPECT_TRUE(found.plan.disassembly.empty()) << trial;
      continue;
    }
    const unsigned steps = truth->first;
    ++by_depth[steps];
    EXPECT_EQ(found.outcome, Outcome::solved) << trial;
    EXPECT_EQ(found.plan.disassembly.size(), steps) << trial;
    ASSERT_TRUE(found.plan.objective.least_cost.has_value()) << trial;
    EXPECT_NEAR(*found.plan.objective.least_cost, steps, 1e-9) << trial;
    // Of several orders with as few steps, that with the fewest changes of direction.
    const RunResult straight = plan_to(target, assembly, counted(0.01), "", 1e5, lattice.constraints);
    EXPECT_EQ(straight.plan.disassembly.size(), steps) << trial;
    EXPECT_NEAR(straight.plan.objective.cost, steps + 0.01 * truth->second, 1e-9) << trial;
    EXPECT_NEAR(straight.plan.objective.least_cost.value_or(0), straight.plan.objective.cost, 1e-9) << trial;
    // With a planner that finds some way itself; with little effort the bound still holds.
    const RunResult planned = plan_to(target, assembly, counted(), "blocking", 1e5, lattice.constraints);
    EXPECT_EQ(planned.outcome, Outcome::solved) << trial;
    EXPECT_LE(planned.plan.disassembly.size(), steps) << trial;  // less where the planner takes groups out
    improved += planned.sequence_counts.at("order_saved") > 0 ? 1 : 0;
    const RunResult poor = plan_to(target, assembly, counted(), "blocking", 4, lattice.constraints);
    EXPECT_GE(poor.plan.disassembly.size(), planned.plan.disassembly.size()) << trial;
    EXPECT_LE(poor.plan.objective.least_cost.value_or(0), planned.plan.disassembly.size() + 1e-9) << trial;
  }
  EXPECT_GT(by_depth[1] + by_depth[2], 20u);
  EXPECT_GT(by_depth[5] + by_depth[6] + by_depth[7], 10u);
  EXPECT_GT(never, 5u);
  EXPECT_GT(improved, 0u);
}

TEST(TargetOrder, KeepsConstraints) {
  const Assembly assembly = fake::tube_with_blocks(5);
  Constraints constraints;
  constraints.base = {0};
  constraints.together = {{4, 5}};
  RunResult r = plan_to(3, assembly, counted(), "", 1e5, constraints);
  ASSERT_EQ(r.plan.disassembly.size(), 2u);
  EXPECT_EQ(r.plan.disassembly[0].separates[0], (std::vector<std::string>{"block4", "block5"}));
  EXPECT_EQ(r.plan.disassembly[1].separates[0], (std::vector<std::string>{"block3"}));
  r = plan_to(3, fake::row(6), counted(), "", 1e5);
  EXPECT_EQ(r.plan.disassembly.size(), 1u);
  constraints = {};
  constraints.before = {{5, 3}, {0, 5}};
  r = plan_to(3, fake::row(6), counted(), "", 1e5, constraints);
  std::string order;
  for (const PlanStep& step : r.plan.disassembly) order += step.separates[0][0] + " ";
  EXPECT_EQ(order, "block0 block5 block3 ");
}

TEST(TargetOrder, CutsAPlanShort) {
  class Ignores final : public fake::InTurn {  // takes everything out, the target last
   public:
    SequencePlannerTraits traits() const noexcept override { return {.keeps_constraints = true, .any_start = true}; }
  };
  const RunResult r = [] {
    BestOrderParameters params;
    params.of = {PluginChoice{"inner", {}, {}},
                 [](PluginKind, const PluginChoice&) -> std::shared_ptr<void> { return std::make_shared<Ignores>(); }};
    PlanningSetup setup = fake::setup(fake::push, std::make_shared<BestOrder>(params));
    setup.objective = counted();
    RunOptions options;
    options.constraints.target = 4;
    RunContext context;
    return run(fake::row(5), setup, options, context);
  }();
  ASSERT_EQ(r.plan.disassembly.size(), 1u);
  EXPECT_EQ(r.plan.disassembly[0].separates[0], (std::vector<std::string>{"block4"}));
  EXPECT_EQ(*r.plan.objective.least_cost, 1);
}

}  // namespace
}  // namespace dismantle
