// Why steps are in their order, for random plans.
#include "dismantle/plan_io/order_words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "dismantle/run_context.h"

namespace dismantle {
namespace {

/// Steps that wait for any earlier ones.
Plan waiting_plan(Rng& rng) {
  Plan plan;
  const std::size_t n = 1 + rng.below(12);
  for (std::size_t s = 0; s < n; ++s) {
    PlanStep step;
    step.step = static_cast<unsigned>(s + 1);
    step.layer = 1;
    for (std::size_t k = 0; k < s; ++k)
      if (rng.below(3) == 0) step.after.push_back(static_cast<unsigned>(k + 1));
    plan.disassembly.push_back(std::move(step));
  }
  return plan;
}

/// The numbers of "steps 2, 5–9 and 12" behind `word`.
std::set<std::size_t> numbers_after(const std::string& text, const std::string& word) {
  std::set<std::size_t> out;
  const std::size_t at = text.find(word + " step");
  if (at == std::string::npos) return out;
  std::string list = text.substr(text.find_first_of("0123456789", at));
  list = list.substr(0, std::min({list.find(':'), list.find(", before"), list.find(", in ")}));
  for (std::size_t dash = list.find("–"); dash != std::string::npos; dash = list.find("–")) list.replace(dash, 3, "-");
  for (std::size_t i = 0; i < list.size();) {
    std::size_t used = 0;
    const std::size_t first = std::stoul(list.substr(i), &used);
    i += used;
    std::size_t last = first;
    if (i < list.size() && list[i] == '-') {
      last = std::stoul(list.substr(++i), &used);
      i += used;
    }
    for (std::size_t k = first; k <= last; ++k) out.insert(k);
    i = std::min(list.find_first_of("0123456789", i), list.size());
  }
  return out;
}

// Law: a step names exactly those that wait for it and those that it waits for; in the assembly it is the other way
// round, with the numbers of the assembly.
TEST(OrderWords, NameWhatHasToComeBeforeAndAfter) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Rng rng(seed);
    const Plan plan = waiting_plan(rng);
    const std::size_t n = plan.disassembly.size();
    for (std::size_t s = 0; s < n; ++s) {
      std::set<std::size_t> earlier, later;
      for (const unsigned k : plan.disassembly[s].after) earlier.insert(k);
      for (std::size_t k = 0; k < n; ++k)
        if (std::ranges::count(plan.disassembly[k].after, s + 1) > 0) later.insert(k + 1);
      const std::string apart = order_words(plan, s, true), back = order_words(plan, s, false);
      EXPECT_EQ(numbers_after(apart, "after"), earlier) << apart;
      EXPECT_EQ(numbers_after(apart, "before"), later) << apart;
      const auto reversed = [&](const std::set<std::size_t>& numbers) {
        std::set<std::size_t> out;
        for (const std::size_t k : numbers) out.insert(n + 1 - k);
        return out;
      };
      EXPECT_EQ(numbers_after(back, "after"), reversed(later)) << back;
      EXPECT_EQ(numbers_after(back, "before"), reversed(earlier)) << back;
      EXPECT_EQ(apart.starts_with("at any place"), earlier.empty() && later.empty());
    }
  }
}

TEST(OrderWords, NothingIsSaidOfWhatWasNotDetermined) {
  Rng rng(1);
  Plan plan = waiting_plan(rng);
  plan.disassembly[0].layer = 0;
  EXPECT_EQ(order_words(plan, 0, false), "");
}

TEST(OrderWords, EachCheckThatCostsNamesItsSteps) {
  Rng rng(4);
  Plan plan = waiting_plan(rng);
  while (plan.disassembly.size() < 5) plan = waiting_plan(rng);
  const std::size_t n = plan.disassembly.size();
  EXPECT_EQ(cost_words(plan, true).size(), 1u);
  EXPECT_NE(cost_words(plan, true)[0].find("no check judged"), std::string::npos);
  for (const char* type : {"gravity", "directions"}) plan.objective.checks.push_back({.type = type});
  EXPECT_EQ(cost_words(plan, true),
            std::vector<std::string>{"no check finds a fault with this order: it costs nothing"});
  plan.objective.checks[1].cost = 3;
  plan.objective.checks[1].weight = 0.5;
  plan.objective.cost = 1.5;
  plan.disassembly[1].checks = {{.type = "gravity", .cost = 0}, {.type = "directions", .cost = 2}};
  plan.disassembly[4].checks = {{.type = "directions", .cost = 1}};
  std::vector<std::string> told = cost_words(plan, true);
  EXPECT_EQ(told, (std::vector<std::string>{"directions: costs 1.5 of 1.5, in steps 2 and 5",
                                            "that no other order costs less is not proved"}));
  EXPECT_NE(cost_words(plan, false)[0].find("in steps " + std::to_string(n - 4) + " and " + std::to_string(n - 1)),
            std::string::npos);
  Plan long_one = plan;
  while (long_one.disassembly.size() < 60) long_one.disassembly.push_back(plan.disassembly[1]);
  EXPECT_NE(cost_words(long_one, true)[0].find("in " + std::to_string(62 - n) + " steps"), std::string::npos)
      << cost_words(long_one, true)[0];
  plan.objective.least_cost = 1.5;
  EXPECT_EQ(cost_words(plan, true).back(), "no order of these motions costs less");
  plan.objective.least_cost = 1;
  EXPECT_EQ(cost_words(plan, true).back(), "no order of these motions costs less than 1: the gap is 33 %");
}

// Law: the place of an alternative is the same one in both modes, with the numbers of the mode; what is cheaper, dearer
// and equal is called so, and the check that says it gives its reason.
TEST(OrderWords, AnotherPlaceSaysWhatItWouldCost) {
  Rng rng(9);
  Plan plan = waiting_plan(rng);
  while (plan.disassembly.size() < 4) plan = waiting_plan(rng);
  const std::size_t n = plan.disassembly.size();
  plan.objective.checks = {{.type = "gravity", .cost = 1}, {.type = "directions", .weight = 2, .cost = 1}};
  plan.objective.cost = 3;
  const auto other = [](unsigned step, unsigned place, double gravity, double directions, std::string why) {
    return PlanAlternative{step,
                           place,
                           {{.type = "gravity", .cost = gravity, .reason = std::move(why)},
                            {.type = "directions", .weight = 2, .cost = directions}}};
  };
  plan.objective.alternatives = {other(0, 0, 2, 4, ""), other(2, 4, 3, 1, "'lid' must be held"), other(3, 1, 1, 1, ""),
                                 other(4, 1, 2, 0, "")};
  EXPECT_EQ(other_place_words(plan, 0, true), "");
  EXPECT_EQ(other_place_words(plan, 1, true), "after step 4 it would cost 2 more: gravity 2 more ('lid' must be held)");
  EXPECT_EQ(other_place_words(plan, 1, false),
            "before step " + std::to_string(n - 3) + " it would cost 2 more: gravity 2 more ('lid' must be held)");
  EXPECT_EQ(other_place_words(plan, 2, true), "before step 1 it would cost as much");
  EXPECT_EQ(other_place_words(plan, 2, false), "after step " + std::to_string(n) + " it would cost as much");
  EXPECT_EQ(other_place_words(plan, 3, true), "before step 1 it would cost 1 less: gravity 1 more, directions 2 less");
  EXPECT_TRUE(order_words(plan, 1, true).ends_with("; " + other_place_words(plan, 1, true)));
  const std::string first = "the order that was found first would cost 10: gravity 1 more, directions 6 more";
  EXPECT_EQ(first_order_words(plan.objective), first);
  EXPECT_EQ(cost_words(plan, false).back(), first);
}

TEST(OrderWords, AChangeNamesTheChecksThatSayOtherwise) {
  PlanObjective before, now;
  EXPECT_EQ(cost_change_words(before, now), "");
  before.checks = now.checks = {{.type = "gravity", .cost = 1}, {.type = "directions", .weight = 2, .cost = 1}};
  before.cost = 3;
  now.checks[1].cost = 2;
  now.cost = 5;
  EXPECT_EQ(cost_change_words(before, now), "it costs 5 (before: 3): directions 4 (2)");
}

}  // namespace
}  // namespace dismantle
