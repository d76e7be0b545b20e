// What a plan says that was checked, not checked, assumed, for random plans.
#include "dismantle/plan_io/plan_account.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "dismantle/plan_io/summary.h"
#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"
#include "random_plan.h"

namespace dismantle {
namespace {

bool says(const std::vector<std::string>& lines, const std::string& text) {
  return std::ranges::any_of(lines, [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

template <class Law>
void for_accounts(Law law) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Rng rng(seed);
    std::vector<std::pair<std::string, Mesh>> meshes;
    for (std::size_t i = 0; i < 2 + rng.below(5); ++i)
      meshes.emplace_back("p" + std::to_string(i), shapes::box({2.0 * double(i), 0, 0}, {2.0 * double(i) + 1, 1, 1}));
    law(random_plan(assembly_of_meshes(meshes, 1, Eigen::Vector3d::Zero()), rng).plan, rng);
  }
}

TEST(PlanAccount, EveryStepIsCheckedOrNot) {
  for_accounts([](const Plan& plan, Rng&) {
    const PlanAccount told = account_of(plan);
    const std::size_t forced = plan.forced_steps(), good = plan.disassembly.size() - forced;
    const auto steps = [](std::size_t n) {
      return "the motion of " + std::to_string(n) + (n == 1 ? " step" : " steps");
    };
    EXPECT_EQ(says(told.checked, "the motion of"), good > 0);
    EXPECT_EQ(says(told.not_checked, "the motion of"), forced > 0);
    EXPECT_TRUE(good == 0 || says(told.checked, steps(good) + " at"));
    EXPECT_TRUE(forced == 0 || says(told.not_checked, steps(forced) + ": forced"));
    EXPECT_EQ(says(told.not_checked, "come apart"), !plan.remaining.empty() && !plan.succeeded());
  });
}

TEST(PlanAccount, AcceptedStepsAreAssumedAndNotOpen) {
  for_accounts([](Plan plan, Rng&) {
    for (PlanStep& step : plan.disassembly)
      if (step.forced) step.forced->accepted = "snap";
    const PlanAccount told = account_of(plan);
    EXPECT_FALSE(says(told.not_checked, "the motion of"));
    EXPECT_EQ(says(told.assumed, "as you accept"), accepted_steps(plan) > 0);
  });
}

TEST(PlanAccount, EachCheckSaysHowManyStepsItJudgedAndWhyNot) {
  for_accounts([](Plan plan, Rng& rng) {
    EXPECT_EQ(says(account_of(plan).not_checked, "what must be held"), !plan.disassembly.empty());
    PlanObjectiveItem item{.type = "gravity"};
    item.parameters = {{"friction", 0.4}, {"density", std::string()}};
    item.plan = PlanVerdict{.type = "gravity", .notes = {{"gravity", "It stands at the end."}}};
    plan.objective.checks = {item};
    std::size_t judged = 0;
    for (PlanStep& step : plan.disassembly) {
      const bool failed = rng.uniform() < 0.3;
      judged += !failed;
      step.checks = {PlanVerdict{.type = "gravity", .failed = failed ? "no mass" : ""}};
    }
    const PlanAccount told = account_of(plan);
    EXPECT_FALSE(says(told.not_checked, "what must be held"));
    EXPECT_TRUE(says(told.checked, "gravity: It stands at the end."));
    EXPECT_TRUE(says(told.assumed, "gravity: friction 0.4"));
    EXPECT_EQ(says(told.checked, "gravity: " + std::to_string(judged) + (judged == 1 ? " step" : " steps")),
              judged > 0);
    EXPECT_EQ(says(told.not_checked, "no mass"), judged < plan.disassembly.size());
  });
}

}  // namespace
}  // namespace dismantle
