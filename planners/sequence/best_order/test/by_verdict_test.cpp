// The order by what a check says, where its estimates say nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "best_order/best_order.h"
#include "dismantle/testing/run_rig.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {
namespace {

/// Parts have ranks. Each part that is there already and has a higher one costs 1. The estimate sees nothing.
class Ranked final : public StepCheck {
 public:
  Ranked(std::vector<std::size_t> ranks, std::size_t& judged) : ranks_(std::move(ranks)), judged_(judged) {}
  StepCheckTraits traits() const noexcept override { return {.reads_path = false, .estimates = true}; }
  StepVerdict judge(const StepQuestion& q, const RunContext&) const override {
    ++judged_;
    StepVerdict verdict;
    for (const PlacedPart& p : q.present) verdict.cost += ranks_[p.part] > ranks_[q.moving.front().part] ? 1 : 0;
    return verdict;
  }
  StepVerdict estimate(const StepQuestion&, const RunContext&) const override { return {}; }

 private:
  std::vector<std::size_t> ranks_;
  std::size_t& judged_;
};

RunResult plan_of(const Assembly& assembly, std::shared_ptr<const StepCheck> check, double effort,
                  std::shared_ptr<SequencePlanner> inner = std::make_shared<fake::InTurn>()) {
  BestOrderParameters params;
  params.effort = effort;
  params.of = {PluginChoice{"inner", {}, {}},
               [inner](PluginKind, const PluginChoice&) -> std::shared_ptr<void> { return inner; }};
  PlanningSetup setup = fake::setup(fake::push, std::make_shared<BestOrder>(params));
  setup.objective = {{{"ranked", std::move(check), 1, false}}};
  RunContext context;
  RunResult result = run(assembly, setup, {}, context);
  EXPECT_TRUE(check_plan(result.plan, assembly, RunOptions{}.verify, context, {}).valid);
  return result;
}

TEST(ByVerdict, FindsTheOrderThatEstimatesDoNotSee) {
  Rng rng(12);
  const Assembly assembly = fake::row(6);
  unsigned dear = 0;
  for (int trial = 0; trial < 8; ++trial) {
    std::vector<std::size_t> ranks(assembly.parts.size());
    std::iota(ranks.begin(), ranks.end(), 0U);
    for (std::size_t i = ranks.size(); i-- > 1;) std::swap(ranks[i], ranks[rng.below(i + 1)]);
    std::size_t judged = 0;
    const RunResult none = plan_of(assembly, std::make_shared<Ranked>(ranks, judged), 0);
    const RunResult best = plan_of(assembly, std::make_shared<Ranked>(ranks, judged), 60000);
    EXPECT_EQ(best.plan.status, PlanStatus::complete) << trial;
    EXPECT_EQ(best.plan.objective.cost, 0) << trial;
    dear += none.plan.objective.cost > 0;
  }
  EXPECT_GT(dear, 5u);
}

// Judgements are counted: few effort, few of them, whatever the plan.
TEST(ByVerdict, JudgesNoMoreThanItsEffort) {
  std::vector<std::size_t> ranks(30);
  std::iota(ranks.begin(), ranks.end(), 0U);
  std::size_t few = 0, many = 0;
  const Assembly assembly = fake::row(30);
  plan_of(assembly, std::make_shared<Ranked>(ranks, few), 6000);
  plan_of(assembly, std::make_shared<Ranked>(ranks, many), 60000);
  EXPECT_LT(few, many);
  EXPECT_LT(many, 29 * 12 + 60000 / (5 * 29) * 2);  // orders that are judged as a whole, and the choices of two plans
}

/// Shifts the last part within the group, then takes the group apart.
class ShiftsFirst final : public fake::InTurn {
 public:
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override {
    SequenceQuery then = query;
    PlacedPart& last = then.start.front().back();
    Attempt attempt = question(query.start.front(), last);
    attempt.goal.placement = true;
    const Pose from = last.pose;
    last.pose.t.y() += 0.3;
    const AttemptResult& answer = oracle.propose(attempt, {{from}, {last.pose}}, context);
    EXPECT_EQ(answer.result.outcome(), Outcome::solved);
    const Removal shift{{last.part}, &answer};
    observer.removed(shift, query.start.front().size());
    SequenceResult result = InTurn::plan(then, oracle, observer, context);
    result.removals.insert(result.removals.begin(), shift);
    return result;
  }
};

// Moves within a group are as few as can be for the separation that follows: it stays the first, though the others
// change places.
TEST(ByVerdict, WhatMovesWithinAGroupLeadToStaysFirst) {
  const Assembly assembly = fake::row(5);
  for (PartId dear = 0; dear < 2; ++dear) {                    // the part that is taken out first, or second
    std::vector<std::size_t> ranks(assembly.parts.size(), 1);  // the dear one wants to leave last
    ranks[dear] = 0;
    std::size_t judged = 0;
    const RunResult best =
        plan_of(assembly, std::make_shared<Ranked>(ranks, judged), 60000, std::make_shared<ShiftsFirst>());
    EXPECT_EQ(best.plan.status, PlanStatus::complete);
    ASSERT_EQ(best.plan.disassembly.size(), 5u);
    EXPECT_EQ(best.plan.disassembly[1].moves.front().part, assembly.parts[0].name) << dear;
    if (dear == 1) {
      EXPECT_NE(best.plan.disassembly[2].moves.front().part, assembly.parts[1].name);
    }
  }
}

}  // namespace
}  // namespace dismantle
