// What other orders cost: the law is that judging such an order says the same.
#include "alternatives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/engine/judgement.h"
#include "dismantle/testing/run_rig.h"

namespace dismantle {
namespace {

/// Costs by the part, the part before it and the number of parts that are there, from a table of chance.
class Tabled final : public StepCheck {
 public:
  Tabled(std::uint64_t seed, bool estimates) : seed_(seed), estimates_(estimates) {}
  StepCheckTraits traits() const noexcept override {
    return {.remembers_shape = true, .reads_path = false, .estimates = estimates_};
  }
  StepVerdict judge(const StepQuestion& q, const RunContext&) const override {
    const std::uint64_t before = q.previous == nullptr ? 99 : q.previous->moving.front().part;
    Rng rng(seed_ + 1000 * q.moving.front().part + 10 * before + 100000 * q.present.size());
    const double cost = static_cast<double>(rng.below(4));
    return {.cost = cost, .reason = cost > 0 ? "by chance" : ""};
  }
  StepVerdict estimate(const StepQuestion& q, const RunContext& context) const override {
    StepVerdict v = judge(q, context);
    if (estimates_) v.cost = 3 - v.cost;
    return v;
  }

 private:
  std::uint64_t seed_;
  bool estimates_;
};

Objective tabled(std::uint64_t seed, bool estimates) {
  return {{{"a", std::make_shared<Tabled>(seed, estimates), 0.5, false, {}},
           {"b", std::make_shared<Tabled>(seed + 7, false), 2, false, {}}}};
}

std::vector<std::size_t> order_with(std::size_t steps, std::size_t step, std::size_t place) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < steps; ++k)
    if (k != step) order.push_back(k);
  order.insert(order.begin() + static_cast<std::ptrdiff_t>(place), step);
  return order;
}

/// The objective of the plan in another order of its steps.
PlanObjective judged(const RunResult& run, const Assembly& assembly, const std::vector<std::size_t>& order,
                     const Objective& objective) {
  Disassembly other(assembly.parts.size());
  for (const std::size_t k : order) other.add(run.disassembly.steps()[k]);
  Plan plan;
  plan.disassembly.resize(order.size());
  judge(plan, other, assembly, objective, RunContext{});
  return plan.objective;
}

/// Does no step come before one that it needs?
bool is_possible(const Plan& plan, const std::vector<std::size_t>& order) {
  std::map<unsigned, std::size_t> at;
  for (std::size_t p = 0; p < order.size(); ++p) at[static_cast<unsigned>(order[p] + 1)] = p;
  return std::ranges::all_of(plan.disassembly, [&](const PlanStep& step) {
    return std::ranges::all_of(step.after, [&](unsigned s) { return at.at(s) < at.at(step.step); });
  });
}

RunResult run_row(const Assembly& assembly, const Objective& objective, const RunOptions& options = {}) {
  PlanningSetup setup = fake::setup(fake::push, std::make_shared<fake::InTurn>());
  setup.objective = objective;
  RunContext context;
  return run(assembly, setup, options, context);
}

// Law: an alternative costs, check by check, what judging the order says in which the one step is at the other place;
// that order is possible; and what does not cost more is the cheapest of all such places, unless estimates chose it.
TEST(OtherPlaces, CostWhatJudgingTheOrderSays) {
  std::size_t stated = 0, dearer = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const bool estimates = seed % 2 == 0;
    const Assembly assembly = fake::row(4 + seed % 5);
    const Objective objective = tabled(seed, estimates);
    const RunResult result = run_row(assembly, objective);
    const std::size_t n = result.plan.disassembly.size();
    for (const PlanAlternative& other : result.plan.objective.alternatives) {
      ASSERT_GE(other.step, 1u);
      const std::vector<std::size_t> order = order_with(n, other.step - 1, other.place - 1);
      ASSERT_TRUE(is_possible(result.plan, order));
      const PlanObjective now = judged(result, assembly, order, objective);
      ASSERT_EQ(other.checks.size(), 2u);
      for (std::size_t c = 0; c < 2; ++c) {
        EXPECT_NEAR(other.checks[c].cost, now.checks[c].cost, 1e-9) << seed << " step " << other.step;
        EXPECT_EQ(other.checks[c].weight, now.checks[c].weight);
        if (other.checks[c].cost > result.plan.objective.checks[c].cost) {
          EXPECT_EQ(other.checks[c].reason, "by chance");
        }
      }
      ++stated;
      dearer += now.cost > result.plan.objective.cost ? 1 : 0;
      if (estimates || now.cost > result.plan.objective.cost + 1e-9) continue;
      double least = result.plan.objective.cost;
      for (std::size_t p = 0; p < n; ++p) {
        const std::vector<std::size_t> also = order_with(n, other.step - 1, p);
        if (p + 1 == other.step || !is_possible(result.plan, also)) continue;
        least = std::min(least, judged(result, assembly, also, objective).cost);
      }
      EXPECT_NEAR(now.cost, least, 1e-9) << seed << " step " << other.step;
    }
  }
  EXPECT_GT(stated, 40u);
  EXPECT_GT(dearer, 10u);
}

TEST(OtherPlaces, KeepTheConstraintsAndTheNumberOfQuestions) {
  const Assembly assembly = fake::row(6);
  std::size_t all = 0, kept = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const RunResult result = run_row(assembly, tabled(seed, false));
    Plan plan = result.plan;
    plan.objective.alternatives.clear();
    Constraints constraints;  // the order of the plan, for all its parts
    for (std::size_t k = 0; k + 1 < result.disassembly.steps().size(); ++k)
      constraints.before.emplace_back(result.disassembly.steps()[k].parts.front(),
                                      result.disassembly.steps()[k + 1].parts.front());
    const std::vector<std::vector<std::size_t>> none(plan.disassembly.size());
    add_other_places(plan, result.disassembly, none, assembly, tabled(seed, false), constraints, RunContext{});
    kept += plan.objective.alternatives.size();
    add_other_places(plan, result.disassembly, none, assembly, tabled(seed, false), {}, RunContext{});
    all += plan.objective.alternatives.size();
    EXPECT_LE(plan.objective.alternatives.size(), 10u);
  }
  EXPECT_EQ(kept, 0u);
  EXPECT_GT(all, 20u);
}

TEST(OtherPlaces, TheFirstOrderIsThatOfTheCounts) {
  Plan plan;
  plan.objective.checks = {{.type = "a", .weight = 2}, {.type = "b"}};
  std::map<std::string, double> counts{{"first_order.0", 3}, {"order_effort", 5}};
  add_first_order(plan, counts);
  EXPECT_TRUE(plan.objective.alternatives.empty()) << "not of all checks";
  counts.insert({{"first_order.0", 3}, {"first_order.1", 1}});
  add_first_order(plan, counts);
  ASSERT_EQ(plan.objective.alternatives.size(), 1u);
  const PlanAlternative& first = plan.objective.alternatives.front();
  EXPECT_EQ(first.step, 0u);
  EXPECT_EQ(first.checks[0].type, "a");
  EXPECT_EQ(first.checks[0].weight, 2);
  EXPECT_EQ(first.checks[0].cost, 3);
  EXPECT_EQ(first.checks[1].cost, 1);
  EXPECT_EQ(counts.size(), 1u);
}

}  // namespace
}  // namespace dismantle
