// A required check of the objective refuses removals; what was refused once may be allowed later.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/testing/run_rig.h"

namespace dismantle {
namespace {

/// Is `part` allowed after `before` (-1: it is the first), with so many parts in place?
using Rule = std::function<bool(int before, PartId part, std::size_t present)>;

class Ruled final : public StepCheck {
 public:
  explicit Ruled(Rule rule) : rule_(std::move(rule)) {}
  StepCheckTraits traits() const noexcept override { return {.remembers_shape = true}; }
  StepVerdict judge(const StepQuestion& q, const RunContext&) const override {
    const int before = q.previous == nullptr ? -1 : static_cast<int>(q.previous->moving.front().part);
    if (rule_(before, q.moving.front().part, q.present.size())) return {};
    return {false, 0, "rule broken"};
  }

 private:
  Rule rule_;
};

RunResult run_with(const Rule& rule, unsigned blocks, bool require = true, ForceWhen force = ForceWhen::off) {
  const Assembly assembly = fake::row(blocks);
  PlanningSetup setup = fake::setup(fake::push, std::make_shared<fake::InTurn>());
  setup.objective.items.push_back({"acme.rule", std::make_shared<Ruled>(rule), 1, require});
  RunOptions options;
  options.force = force;
  RunContext context;
  return run(assembly, setup, options, context);
}

std::vector<std::string> order_of(const Plan& plan) {
  std::vector<std::string> names;
  for (const PlanStep& step : plan.disassembly) names.push_back(step.moves.front().part);
  return names;
}

TEST(Required, WhatIsRefusedWaits) {
  const auto not_the_last = [](int, PartId part, std::size_t present) { return part != 0 || present < 2; };
  const RunResult result = run_with(not_the_last, 3);
  EXPECT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(order_of(result.plan), (std::vector<std::string>{"block1", "block0"}));
  EXPECT_EQ(order_of(run_with(not_the_last, 3, false).plan), (std::vector<std::string>{"block0", "block1"}))
      << "not required: stated only";
  EXPECT_TRUE(result.plan.objective.checks[0].require);
}

TEST(Required, WhenAllOrdersAreRefusedThePlanNamesTheCheck) {
  for (const ForceWhen force : {ForceWhen::off, ForceWhen::last_resort}) {
    const RunResult result = run_with([](int, PartId, std::size_t) { return false; }, 3, true, force);
    EXPECT_EQ(result.outcome, Outcome::exhausted);
    EXPECT_EQ(result.plan.status, PlanStatus::partial);
    EXPECT_TRUE(result.plan.disassembly.empty());
    ASSERT_EQ(result.plan.unsolved.size(), 3u);
    for (const PlanUnsolved& u : result.plan.unsolved) {
      EXPECT_EQ(u.refused_by, "acme.rule");
      EXPECT_NE(u.message.find("'acme.rule', which is required, does not allow it: rule broken"), std::string::npos)
          << u.message;
    }
  }
}

// Law: whatever a required check allows, all steps of the plan are allowed; and parts are left only if it refused some.
TEST(Required, EveryStepIsAllowed) {
  Rng rng(9);
  unsigned complete = 0, partial = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const unsigned n = 3 + static_cast<unsigned>(rng.below(3));
    std::vector<bool> allowed;
    const double share = rng.uniform();
    for (unsigned k = 0; k < (n + 1) * n; ++k) allowed.push_back(rng.uniform() < share);
    const Plan plan = run_with([&](int before, PartId part,
                                   std::size_t) { return allowed[static_cast<std::size_t>(before + 1) * n + part]; },
                               n)
                          .plan;
    for (const PlanStep& step : plan.disassembly) EXPECT_TRUE(step.checks.at(0).allowed) << step.step;
    ++(plan.status == PlanStatus::complete ? complete : partial);
    for (const PlanUnsolved& u : plan.unsolved) EXPECT_EQ(u.refused_by, "acme.rule");
  }
  EXPECT_GT(complete, 5u);
  EXPECT_GT(partial, 5u);
}

}  // namespace
}  // namespace dismantle
