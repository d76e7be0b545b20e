// The way to one unit, compared with all orders of small made-up problems.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "dismantle/ordering/order_search.h"
#include "dismantle/ordering/target_bound.h"
#include "dismantle/run_context.h"

namespace dismantle::order {
namespace {

/// Units that block each other at random, in circles, too; some leave in pairs.
class RandomLoops final : public Problem {
 public:
  RandomLoops(std::size_t units, std::uint64_t seed, bool remembers)
      : of_unit_(units), in_pair_(units), remembers_(remembers) {
    Rng rng(seed);
    for (std::size_t u = 0; u < units; ++u)
      for (std::size_t k = rng.below(4); k > 0; --k) add(rng, {u});
    for (std::size_t k = rng.below(3); k > 0; --k) {
      const std::size_t a = rng.below(units - 1);
      add(rng, {a, a + 1});
      in_pair_.insert(a);
      in_pair_.insert(a + 1);
    }
  }
  std::size_t units() const override { return of_unit_.size(); }
  const std::vector<VariantId>& variants_of(std::size_t unit) const override { return of_unit_[unit]; }
  bool leaves_alone(std::size_t unit) const override { return !in_pair_.contains(unit); }
  const UnitSet& leaving(VariantId v) const override { return all_[v].units; }
  bool may_leave(VariantId v, const UnitSet& present) override { return !all_[v].blocking.intersects(present); }
  const UnitSet& blocking(VariantId v) override { return all_[v].blocking; }
  double cost(VariantId v, const UnitSet& /*rest*/, VariantId previous) override {
    return all_[v].cost + (remembers_ && previous != kNone && all_[previous].kind != all_[v].kind ? 0.5 : 0);
  }
  double least(VariantId v) const override { return all_[v].cost; }
  std::uint64_t classes(VariantId v) const override { return std::uint64_t{1} << all_[v].kind; }
  double change() const override { return remembers_ ? 0.5 : 0; }
  bool alike(VariantId a, VariantId b) const override { return all_[a].kind == all_[b].kind; }

 private:
  struct Variant {
    UnitSet units, blocking;
    double cost = 0;
    std::size_t kind = 0;
  };
  void add(Rng& rng, const std::vector<std::size_t>& leaving) {
    Variant v{UnitSet(units()), UnitSet(units()), 1 + 0.25 * static_cast<double>(rng.below(3)), rng.below(3)};
    for (std::size_t other = 0; other < units(); ++other)
      if (rng.uniform() < 0.3) v.blocking.insert(other);
    for (const std::size_t u : leaving) v.units.insert(u);
    v.blocking -= v.units;
    of_unit_[leaving.front()].push_back(all_.size());
    all_.push_back(v);
  }

  std::vector<Variant> all_;
  std::vector<std::vector<VariantId>> of_unit_;
  UnitSet in_pair_;
  bool remembers_;
};

/// By the definition: all orders, one after the other.
double cheapest_to(RandomLoops& problem, const UnitSet& left, std::size_t target, VariantId last) {
  if (!left.contains(target) || left.size() == 1) return last == kNone ? 0 : problem.cost(last, left, kNone);
  double best = kForbidden;
  left.each([&](std::size_t u) {
    for (const VariantId v : problem.variants_of(u)) {
      const UnitSet& leaving = problem.leaving(v);
      if (!left.includes(leaving) || leaving == left || (leaving.contains(target) && leaving.size() > 1)) continue;
      if (problem.may_leave(v, left))
        best = std::min(
            best, (last == kNone ? 0 : problem.cost(last, left, v)) + cheapest_to(problem, left - leaving, target, v));
    }
  });
  return best;
}

struct Question {
  Question(RandomLoops& problem, double known, bool may_stay)
      : bound(problem, UnitSet(problem.units(), true), 0, known, may_stay) {
    task.start = UnitSet(problem.units(), true);
    task.end = End::target;
    task.bound = &bound;
  }
  TargetBound bound;
  Task task;
};

TEST(Target, BestFirstFindsTheCheapestOfAllOrders) {
  unsigned possible = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    RandomLoops problem(3 + seed % 4, seed, seed % 2 == 0);
    const double truth = cheapest_to(problem, UnitSet(problem.units(), true), 0, kNone);
    Question q(problem, kForbidden, true);
    Effort effort{1000000};
    const BestFirst found = best_first(problem, q.task, kForbidden, effort);
    ASSERT_TRUE(found.complete);
    EXPECT_EQ(found.best.cost < kForbidden, truth < kForbidden) << seed;
    if (!(truth < kForbidden)) continue;
    ++possible;
    EXPECT_NEAR(found.best.cost, truth, 1e-9) << seed;
    EXPECT_NEAR(found.bound, truth, 1e-9) << seed;
    EXPECT_NEAR(cost_of(problem, q.task, found.best.variants), truth, 1e-9) << seed;
    EXPECT_TRUE(is_feasible(problem, q.task, found.best.variants)) << seed;
  }
  EXPECT_GT(possible, 60u);
}

TEST(Target, TheBoundIsNeverAboveTheCheapestOrder) {
  unsigned exact = 0, possible = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    RandomLoops problem(3 + seed % 5, 5000 + seed, false);
    const UnitSet all(problem.units(), true);
    const double truth = cheapest_to(problem, all, 0, kNone);
    Question q(problem, kForbidden, true);
    EXPECT_LE(q.bound.of(all), truth + 1e-9) << seed;
    possible += truth < kForbidden ? 1 : 0;
    exact += truth < kForbidden && q.bound.of(all) > truth - 1e-9 ? 1 : 0;
    for (const std::uint64_t effort_of : {1, 5, 20}) {
      Effort effort{effort_of};
      EXPECT_LE(best_first(problem, q.task, kForbidden, effort).bound, truth + 1e-9) << seed;
    }
  }
  EXPECT_GT(2 * exact, possible) << "a bound that says something";
}

/// What costs too much is left out before the search, and nothing else.
TEST(Target, ACheaperOrderThanTheKnownOneIsFoundOrThereIsNone) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    RandomLoops problem(6, 9000 + seed, true);
    const double truth = cheapest_to(problem, UnitSet(6, true), 0, kNone);
    if (!(truth < kForbidden)) continue;
    Effort effort{1000000};
    Question none(problem, truth, true);
    EXPECT_TRUE(best_first(problem, none.task, truth, effort).best.variants.empty()) << seed;
    Question some(problem, truth + 0.1, true);
    EXPECT_NEAR(best_first(problem, some.task, truth + 0.1, effort).best.cost, truth, 1e-9) << seed;
    // If the target has to move, nothing is lost but orders in which everything else leaves.
    Question moves(problem, kForbidden, false);
    const BestFirst found = best_first(problem, moves.task, kForbidden, effort);
    EXPECT_GE(found.best.cost, truth - 1e-9) << seed;
    EXPECT_LE(std::min(found.best.cost, moves.bound.least_if_it_stays(UnitSet(6, true))), truth + 1e-9) << seed;
  }
}

TEST(Target, SomeOrderIsFoundWithoutASearch) {
  unsigned possible = 0, found = 0, cheapest_ones = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    RandomLoops problem(3 + seed % 5, 25000 + seed, false);
    const UnitSet all(problem.units(), true);
    const double truth = cheapest_to(problem, all, 0, kNone);
    Question q(problem, kForbidden, true);
    const std::vector<VariantId> some = q.bound.some_order(all);
    possible += truth < kForbidden ? 1 : 0;
    if (some.empty() || !is_feasible(problem, q.task, some)) continue;  // pairs may be in each other's way
    ++found;
    const double cost = cost_of(problem, q.task, some);
    EXPECT_GE(cost, truth - 1e-9) << seed;
    cheapest_ones += cost < truth + 1e-9 ? 1 : 0;
  }
  EXPECT_GT(10 * found, 7 * possible);
  EXPECT_GT(10 * cheapest_ones, 8 * found);
}

/// Step by step, with the bounds that it states.
TEST(Target, TheWayToItIsTheCheapestOfAllOrders) {
  unsigned possible = 0, poor_ones = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    RandomLoops problem(3 + seed % 5, 15000 + seed, seed % 2 == 0);
    const UnitSet all(problem.units(), true);
    const double truth = cheapest_to(problem, all, 0, kNone);
    Effort effort{1000000};
    const TargetOrder option = order_to(problem, all, 0, kForbidden, effort);
    EXPECT_TRUE(option.complete) << seed;
    EXPECT_EQ(option.best.cost < kForbidden, truth < kForbidden) << seed;
    if (!(truth < kForbidden)) continue;
    ++possible;
    EXPECT_NEAR(option.best.cost, truth, 1e-9) << seed;
    EXPECT_NEAR(option.bound, truth, 1e-9) << seed;
    EXPECT_LE(option.least, truth + 1e-9) << seed;
    EXPECT_LE(option.floor, option.least + 1e-9) << seed;
    const TargetOrder none = order_to(problem, all, 0, truth, effort);
    EXPECT_TRUE(none.best.variants.empty()) << seed;
    EXPECT_NEAR(none.bound, truth, 1e-9) << seed;
    Effort little{10};
    const TargetOrder poor = order_to(problem, all, 0, kForbidden, little);
    EXPECT_LE(poor.bound, truth + 1e-9) << seed;
    EXPECT_GE(poor.best.cost, truth - 1e-9) << seed;
    poor_ones += poor.complete ? 0 : 1;
  }
  EXPECT_GT(possible, 80u);
  EXPECT_GT(poor_ones, 10u);
}

TEST(Target, BeamAndWindowsGiveOrdersThatAreFeasible) {
  unsigned found_some = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    RandomLoops problem(6 + seed % 3, 12000 + seed, true);
    Question q(problem, kForbidden, true);
    Effort effort{4000}, more{20000};
    Order found = beam(problem, q.task, effort);
    if (!(found.cost < kForbidden)) continue;
    ++found_some;
    const double by_beam = found.cost;
    improve(problem, q.task, found, more);
    EXPECT_LE(found.cost, by_beam + 1e-9) << seed;
    EXPECT_TRUE(is_feasible(problem, q.task, found.variants)) << seed;
  }
  EXPECT_GT(found_some, 10u);
}

}  // namespace
}  // namespace dismantle::order
