// The order of a plan, compared with the cheapest of all orders of blocks on a lattice, which a search of its own
// finds.
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lattice_orders.h"

namespace dismantle {
namespace {

using Eigen::Vector3d;
using lattice::AllOrders;
using lattice::Lattice;
using lattice::plan_of;
using lattice::priced;
using lattice::Prices;

TEST(BestOrder, IsTheCheapestOfAllOrdersOfBlocksOnALattice) {
  Rng rng(53);
  unsigned compared = 0, improved = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const Lattice lattice = Lattice::random(rng);
    Prices prices;
    for (double& price : prices.direction) price = 0.25 * static_cast<double>(rng.below(4));
    prices.present = trial % 2 == 0 ? 0 : 0.25;
    const double truth = AllOrders(lattice, prices).cheapest((1U << lattice.parts) - 1, std::nullopt);
    if (!(truth < std::numeric_limits<double>::infinity())) continue;
    ++compared;
    const Assembly assembly = lattice.assembly();
    const RunResult best = plan_of(assembly, priced(prices), std::make_shared<fake::InTurn>(), 1e6);
    ASSERT_EQ(best.plan.status, PlanStatus::complete) << trial;
    EXPECT_NEAR(best.plan.objective.cost, truth, 1e-9) << trial;
    ASSERT_TRUE(best.plan.objective.least_cost.has_value());
    EXPECT_NEAR(*best.plan.objective.least_cost, truth, 1e-9) << trial;
    const double saved = best.sequence_counts.at("order_saved");
    improved += saved > 0 ? 1 : 0;
    if (saved > 0) {  // the plan says what it costs otherwise
      ASSERT_FALSE(best.plan.objective.alternatives.empty());
      const PlanAlternative& first = best.plan.objective.alternatives.front();
      EXPECT_EQ(first.step, 0u);
      EXPECT_NEAR(first.checks.at(0).cost, best.plan.objective.cost + saved, 1e-9) << trial;
    }
    EXPECT_FALSE(best.sequence_counts.contains("first_order.0"));
    // With little effort the bound still holds.
    const RunResult poor = plan_of(assembly, priced(prices), std::make_shared<fake::InTurn>(), 60);
    EXPECT_LE(*poor.plan.objective.least_cost, truth + 1e-9) << trial;
    EXPECT_GE(poor.plan.objective.cost, truth - 1e-9) << trial;
  }
  EXPECT_GT(compared, 8u);
  EXPECT_GT(improved, 4u);
}

TEST(BestOrder, WithoutAnObjectiveThePlanIsThatOfTheInnerPlannerToTheLastBit) {
  const Assembly assembly = fake::row(6);
  const RunResult inner = fake::run_in_turn(assembly);
  const RunResult best = plan_of(assembly, {}, std::make_shared<fake::InTurn>(), 1e5);
  EXPECT_EQ(fake::text_without_times(best.plan), fake::text_without_times(inner.plan));
}

TEST(BestOrder, KeepsTheInnerPlanWithoutEffort) {
  const Assembly assembly = fake::row(6);
  Prices prices;
  prices.direction = {3, 2, 1, 4, 5, 6};
  const RunResult cheap = plan_of(assembly, priced(prices), std::make_shared<fake::InTurn>(), 1e5);
  const RunResult none = plan_of(assembly, priced(prices), std::make_shared<fake::InTurn>(), 0);
  EXPECT_LT(cheap.plan.objective.cost, none.plan.objective.cost);
  EXPECT_EQ(none.plan.status, PlanStatus::complete);
  EXPECT_EQ(none.sequence_counts.at("order_saved"), 0);
}

/// A search that cannot end is not begun: what is judged then is the plan, and other places of five of its steps: eight
/// on each side, with three operations more for each place further away.
TEST(BestOrder, ManyStepsAreLeftAsTheyAreWhereTheEffortDoesNotSuffice) {
  std::size_t judged = 0;
  class Counted final : public StepCheck {
   public:
    explicit Counted(std::size_t& count) : count_(count) {}
    StepCheckTraits traits() const noexcept override { return {}; }
    StepVerdict judge(const StepQuestion&, const RunContext&) const override {
      ++count_;
      return {.cost = 1, .reason = "one for each step"};
    }

   private:
    std::size_t& count_;
  };
  const Objective objective{{{"counted", std::make_shared<Counted>(judged), 1, false}}};
  const Assembly assembly = fake::row(40);
  const RunResult enough = plan_of(assembly, objective, std::make_shared<fake::InTurn>(), 4000);
  EXPECT_GT(enough.sequence_counts.at("order_effort"), 0);
  EXPECT_GT(judged, 200u);
  judged = 0;
  const RunResult little = plan_of(assembly, objective, std::make_shared<fake::InTurn>(), 1000);
  EXPECT_EQ(little.sequence_counts.at("order_effort"), 0);
  EXPECT_LE(judged, 39u + 5 * 2 * 8 * 3) << "once for the plan file";
  EXPECT_EQ(little.plan.status, PlanStatus::complete);
}

TEST(BestOrder, ACheckThatThrowsLeavesThePlanAsItIs) {
  class Throws final : public StepCheck {
   public:
    StepCheckTraits traits() const noexcept override { return {}; }
    StepVerdict judge(const StepQuestion&, const RunContext&) const override { throw std::runtime_error("broken"); }
  };
  RunContext context;
  unsigned errors = 0;
  context.on_log = [&](LogLevel level, std::string_view) { errors += level == LogLevel::error ? 1 : 0; };
  const RunResult r = plan_of(fake::row(4), {{{"throws", std::make_shared<Throws>(), 1, false}}},
                              std::make_shared<fake::InTurn>(), 1e5, {}, context);
  EXPECT_EQ(r.plan.status, PlanStatus::complete);
  EXPECT_GT(errors, 0u);
}

/// The whole is turned when that is cheaper: blocks come from above, seen as it lies.
TEST(BestOrder, TurnsTheWholeWhereThatCostsLess) {
  class FromAbove final : public StepCheck {
   public:
    StepCheckTraits traits() const noexcept override {
      return {.remembers_orientation = true, .reads_present = false, .reads_path = false};
    }
    StepVerdict judge(const StepQuestion& q, const RunContext&) const override {
      StepVerdict verdict;
      verdict.cost = q.direction.dot(-q.up) > 0.9 ? 0 : 10;
      if (q.previous != nullptr && q.previous->up.dot(q.up) < 0.9) verdict.cost += 1;
      return verdict;
    }
  };
  // The tube is open at +x when it is turned; its blocks leave only there.
  Assembly assembly = fake::tube_with_blocks(3);
  for (Part& part : assembly.parts) {
    Mesh turned = *part.mesh;
    for (Vector3d& v : turned.vertices) v = {v.z(), v.x(), v.y()};
    part.mesh = part.surface = std::make_shared<const Mesh>(std::move(turned));
  }
  const RunResult r =
      plan_of(assembly, {{{"above", std::make_shared<FromAbove>(), 1, false}}}, std::make_shared<fake::InTurn>(), 1e5);
  ASSERT_EQ(r.plan.status, PlanStatus::complete);
  EXPECT_EQ(r.plan.objective.cost, 0);
  for (const PlanStep& step : r.plan.disassembly) {
    ASSERT_TRUE(step.up.has_value());
    EXPECT_GT(std::abs(step.up->x()), 0.9);  // or the tube is put over the blocks
  }
  ASSERT_TRUE(r.plan.objective.least_cost.has_value());
  EXPECT_EQ(*r.plan.objective.least_cost, 0);
}

/// As InTurn, in this order.
class GivenOrder final : public SequencePlanner {
 public:
  explicit GivenOrder(std::vector<PartId> order) : order_(std::move(order)) {}
  SequencePlannerTraits traits() const noexcept override { return {.keeps_constraints = true, .any_start = true}; }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override {
    SequenceResult result;
    std::vector<PlacedPart> left = query.start.front();
    for (const PartId id : order_) {
      const auto at = std::find_if(left.begin(), left.end(), [&](const PlacedPart& p) { return p.part == id; });
      result.removals.push_back({{id}, &oracle.attempt(fake::InTurn::question(left, *at), context)});
      left.erase(at);
      observer.removed(result.removals.back(), left.size());
    }
    result.outcome = Outcome::solved;
    return result;
  }

 private:
  std::vector<PartId> order_;
};

TEST(BestOrder, KeepsConstraints) {
  const Assembly assembly = fake::row(5);
  Prices prices;
  prices.direction = {3, 2, 1, 4, 5, 6};
  RunOptions options;
  options.constraints.base = {2};
  options.constraints.before = {{4, 0}, {3, 1}};
  const RunResult r =
      plan_of(assembly, priced(prices), std::make_shared<GivenOrder>(std::vector<PartId>{4, 3, 1, 0}), 1e5, options);
  ASSERT_EQ(r.plan.status, PlanStatus::complete);
  std::map<std::string, std::size_t> place;
  for (const PlanStep& step : r.plan.disassembly) place[step.moves.front().part] = place.size();
  EXPECT_EQ(place.size(), 4u);
  EXPECT_FALSE(place.contains("block2"));
  EXPECT_LT(place["block4"], place["block0"]);
  EXPECT_LT(place["block3"], place["block1"]);
}

/// It costs when the part moves.
class Stays final : public StepCheck {
 public:
  explicit Stays(PartId part) : part_(part) {}
  StepCheckTraits traits() const noexcept override { return {.reads_present = false, .reads_path = false}; }
  StepVerdict judge(const StepQuestion& q, const RunContext&) const override {
    StepVerdict verdict;
    verdict.cost = std::any_of(q.moving.begin(), q.moving.end(), [&](const PlacedPart& p) { return p.part == part_; });
    return verdict;
  }

 private:
  PartId part_;
};

/// A tray, a filler in it, and a clamp that holds a pin: the pin leaves the clamp only sideways, where the filler is.
Assembly tray() {
  return fake::assembly_of(
      {{"tray",
        {{{0, 0, 0}, {10, 6, 1}},
         {{0, 0, 1}, {1, 6, 4}},
         {{9, 0, 1}, {10, 6, 4}},
         {{1, 0, 1}, {9, 1, 4}},
         {{1, 5, 1}, {9, 6, 4}}}},
       {"clamp", {{{1.2, 1.2, 1.2}, {1.8, 4.8, 3.9}}, {{1.8, 1.2, 1.2}, {4, 4.8, 2}}, {{1.8, 1.2, 3}, {4, 4.8, 3.9}}}},
       {"pin", {{{2, 1.4, 2.1}, {4, 4.6, 2.9}}}},
       {"filler", {{{4.3, 1.2, 1.2}, {8.8, 4.8, 3.9}}}}});
}

TEST(BestOrder, BuildsAroundTheLargestPartWhereThatCostsLess) {
  const Assembly assembly = tray();
  const auto inner = std::make_shared<GivenOrder>(std::vector<PartId>{0, 3, 2});  // the tray is put over the rest
  const RunResult r = plan_of(assembly, {{{"stays", std::make_shared<Stays>(0), 1, false}}}, inner, 1e5);
  ASSERT_EQ(r.plan.status, PlanStatus::complete);
  EXPECT_EQ(r.plan.objective.cost, 0);
  ASSERT_EQ(r.plan.disassembly.size(), 3u);
  std::vector<std::size_t> sizes;
  for (const PlanStep& step : r.plan.disassembly) sizes.push_back(step.moves.size());
  EXPECT_EQ(sizes, (std::vector<std::size_t>{1, 2, 1})) << "clamp and pin are a sub-assembly";
  EXPECT_GT(r.sequence_counts.at("order_saved"), 0);
}

TEST(BestOrder, DoesNotBuildAroundTheLargestPartWhereThatCostsMore) {
  const Assembly assembly = tray();
  const auto inner = std::make_shared<GivenOrder>(std::vector<PartId>{0, 3, 2});
  const RunResult r = plan_of(assembly, {{{"stays", std::make_shared<Stays>(1), 1, false}}}, inner, 1e5);
  ASSERT_EQ(r.plan.status, PlanStatus::complete);
  EXPECT_EQ(r.plan.objective.cost, 0);
  const auto moves_tray = [](const PlanStep& step) { return step.moves.front().part == "tray"; };
  EXPECT_EQ(std::count_if(r.plan.disassembly.begin(), r.plan.disassembly.end(), moves_tray), 1);
}

TEST(BestOrder, DoesNotMoveWhatTheBaseHolds) {
  const Assembly assembly = tray();
  RunOptions options;
  options.constraints.base = {1};
  const auto inner = std::make_shared<GivenOrder>(std::vector<PartId>{0, 3, 2});
  const RunResult r = plan_of(assembly, {{{"stays", std::make_shared<Stays>(0), 1, false}}}, inner, 1e5, options);
  ASSERT_EQ(r.plan.status, PlanStatus::complete);
  for (const PlanStep& step : r.plan.disassembly)
    for (const PlanMove& move : step.moves) EXPECT_NE(move.part, "clamp");
}

}  // namespace
}  // namespace dismantle
