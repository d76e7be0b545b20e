// The search over sets of units, compared with all orders of small made-up problems.
#include "dismantle/ordering/order_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <tuple>
#include <vector>

#include "dismantle/ordering/class_changes.h"
#include "dismantle/run_context.h"

namespace dismantle::order {
namespace {

/// Units that block each other at random, with costs at random: of the variant, of the rest that it leaves, and of a
/// change of the class.
class Random final : public Problem {
 public:
  Random(std::size_t units, std::uint64_t seed, bool reads_rest) : Random(units, Rng(seed), reads_rest) {}

  std::size_t units() const override { return of_unit_.size(); }
  const std::vector<VariantId>& variants_of(std::size_t unit) const override { return of_unit_[unit]; }
  bool leaves_alone(std::size_t unit) const override { return !in_pair_.contains(unit); }
  const UnitSet& leaving(VariantId v) const override { return all_[v].units; }
  bool may_leave(VariantId v, const UnitSet& present) override { return !all_[v].blocking.intersects(present); }
  const UnitSet& blocking(VariantId v) override { return all_[v].blocking; }
  double cost(VariantId v, const UnitSet& rest, VariantId previous) override {
    double cost = all_[v].cost;
    if (reads_rest_) cost += static_cast<double>((rest.hash() + v) % 3);
    if (previous != kNone && all_[previous].kind != all_[v].kind) cost += 2;
    return cost;
  }
  double least(VariantId v) const override { return all_[v].cost; }
  std::uint64_t classes(VariantId v) const override { return std::uint64_t{1} << all_[v].kind; }
  double change() const override { return 2; }
  bool alike(VariantId a, VariantId b) const override { return all_[a].kind == all_[b].kind; }

 private:
  struct Variant {
    UnitSet units, blocking;
    double cost = 0;
    std::size_t kind = 0;
  };

  Random(std::size_t units, Rng rng, bool reads_rest) : in_pair_(units), of_unit_(units), reads_rest_(reads_rest) {
    std::vector<std::size_t> ranks(units);
    for (std::size_t u = 0; u < units; ++u) ranks[u] = u;
    for (std::size_t n = units; n > 1; --n) std::swap(ranks[n - 1], ranks[rng.below(n)]);
    for (std::size_t u = 0; u < units; ++u)
      for (std::size_t k = 1 + rng.below(3); k > 0; --k) add(rng, {u}, ranks, units);
    for (std::size_t k = rng.below(3); k > 0 && units > 3; --k) {
      const std::size_t a = rng.below(units - 1);
      add(rng, {a, a + 1}, ranks, units);
      in_pair_.insert(a);
      in_pair_.insert(a + 1);
    }
  }
  void add(Rng& rng, std::vector<std::size_t> leaving, const std::vector<std::size_t>& ranks, std::size_t units) {
    Variant v{UnitSet(units), UnitSet(units), static_cast<double>(rng.below(3)), rng.below(4)};
    for (const std::size_t u : leaving) v.units.insert(u);
    for (std::size_t other = 0; other < units; ++other)
      if (ranks[other] < ranks[leaving.front()] && rng.uniform() < 0.3) v.blocking.insert(other);
    v.blocking = v.blocking - v.units;
    of_unit_[leaving.front()].push_back(all_.size());
    all_.push_back(v);
  }

  UnitSet in_pair_;
  std::vector<Variant> all_;
  std::vector<std::vector<VariantId>> of_unit_;
  bool reads_rest_;
};

/// By the definition of the cost: all orders, one after the other.
double cheapest(Random& problem, const UnitSet& left, VariantId last, std::size_t stay) {
  double best = kForbidden;
  if (left.size() <= stay) best = last == kNone ? 0 : problem.cost(last, left, kNone);
  if (left.size() <= stay) return best;
  left.each([&](std::size_t u) {
    for (const VariantId v : problem.variants_of(u))
      if (left.includes(problem.leaving(v)) && !(problem.leaving(v) == left) && problem.may_leave(v, left))
        best = std::min(best, (last == kNone ? 0 : problem.cost(last, left, v)) +
                                  cheapest(problem, left - problem.leaving(v), v, stay));
  });
  return best;
}

/// The fewest changes of the class over all orders, one after the other.
double fewest_changes(Random& problem, const UnitSet& left, VariantId last) {
  if (left.size() <= 1) return 0;
  double fewest = kForbidden;
  left.each([&](std::size_t u) {
    for (const VariantId v : problem.variants_of(u))
      if (left.includes(problem.leaving(v)) && !(problem.leaving(v) == left) && problem.may_leave(v, left))
        fewest = std::min(fewest, (last != kNone && !problem.alike(last, v) ? 1 : 0) +
                                      fewest_changes(problem, left - problem.leaving(v), v));
  });
  return fewest;
}

Task whole(const Problem& problem) {
  Task task;
  task.start = UnitSet(problem.units(), true);
  return task;
}

TEST(OrderSearch, BestFirstFindsTheCheapestOfAllOrders) {
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    Random problem(3 + seed % 4, seed, seed % 2 == 0);
    const Task task = whole(problem);
    Effort effort{1000000};
    const BestFirst found = best_first(problem, task, kForbidden, effort);
    const double truth = cheapest(problem, task.start, kNone, 1);
    ASSERT_TRUE(found.complete);
    EXPECT_NEAR(found.best.cost, truth, 1e-9) << seed;
    EXPECT_NEAR(found.bound, truth, 1e-9) << seed;
    if (!(truth < kForbidden)) continue;
    EXPECT_NEAR(cost_of(problem, task, found.best.variants), truth, 1e-9) << seed;
  }
}

TEST(OrderSearch, TheBoundIsNeverAboveTheCheapestOrder) {
  unsigned above_zero = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    Random problem(3 + seed % 4, 1000 + seed, seed % 2 == 0);
    const Task task = whole(problem);
    const double truth = cheapest(problem, task.start, kNone, 1);
    const double bound = lower_bound(problem, task, task.start, kNone);
    EXPECT_LE(bound, truth + 1e-9) << seed;
    above_zero += bound > 0 ? 1 : 0;
    for (const std::uint64_t effort_of : {1, 5, 20, 60}) {
      Effort effort{effort_of};
      const BestFirst found = best_first(problem, task, kForbidden, effort);
      EXPECT_LE(found.bound, truth + 1e-9) << seed << " with effort " << effort_of;
    }
  }
  EXPECT_GT(above_zero, 40u) << "a bound that says something";
}

TEST(OrderSearch, ClassesChangeAtLeastAsOftenAsInTheBestOfAllOrders) {
  unsigned changes = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    Random problem(3 + seed % 4, 4000 + seed, true);
    const Task task = whole(problem);
    const double truth = fewest_changes(problem, task.start, kNone);
    if (!(truth < kForbidden)) continue;
    const auto class_of = [&](VariantId v) { return static_cast<std::size_t>(std::countr_zero(problem.classes(v))); };
    Effort effort{100000};
    const auto found = static_cast<double>(least_class_changes(problem, task, class_of, effort));
    bool pairs = false;  // what leaves in pairs may be counted too low
    for (std::size_t u = 0; u < problem.units(); ++u) pairs = pairs || !problem.leaves_alone(u);
    if (pairs)
      EXPECT_LE(found, truth) << seed;
    else
      EXPECT_EQ(found, truth) << seed;
    changes += !pairs && truth > 0 ? 1 : 0;
    for (const std::uint64_t little : {0, 1, 3, 10}) {
      Effort less{little};
      EXPECT_LE(static_cast<double>(least_class_changes(problem, task, class_of, less)), found) << seed;
    }
  }
  EXPECT_GT(changes, 10u) << "a number that says something";
}

TEST(OrderSearch, ACheaperOrderThanTheKnownOneIsFoundOrThereIsNone) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random problem(5, 2000 + seed, true);
    const Task task = whole(problem);
    const double truth = cheapest(problem, task.start, kNone, 1);
    if (!(truth < kForbidden)) continue;
    Effort effort{1000000};
    const BestFirst none = best_first(problem, task, truth, effort);
    EXPECT_TRUE(none.complete);
    EXPECT_TRUE(none.best.variants.empty());
    EXPECT_NEAR(none.bound, truth, 1e-9);
  }
}

TEST(OrderSearch, BeamAndWindowsGiveOrdersThatAreFeasible) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random problem(6 + seed % 8, 3000 + seed, seed % 2 == 0);
    const Task task = whole(problem);
    Effort effort{4000};
    Order found = beam(problem, task, effort);
    if (!(found.cost < kForbidden)) continue;  // nothing comes apart
    const double by_beam = found.cost;
    EXPECT_NEAR(cost_of(problem, task, found.variants), by_beam, 1e-9) << seed;
    Effort more{20000};
    improve(problem, task, found, more);
    EXPECT_LE(found.cost, by_beam + 1e-9) << seed;
    UnitSet left = task.start;
    for (const VariantId v : found.variants) {
      EXPECT_TRUE(left.includes(problem.leaving(v)) && problem.may_leave(v, left)) << seed;
      left = left - problem.leaving(v);
    }
    EXPECT_EQ(left.size(), 1u) << seed;
  }
}

/// A ring of units: a state costs as much as its arcs have ends. What a step leaves behind costs in the next one.
class Ring final : public Problem {
 public:
  explicit Ring(std::size_t units) {
    for (std::size_t u = 0; u < units; ++u) {
      UnitSet one(units);
      one.insert(u);
      leaving_.push_back(one);
      own_.push_back({u});
    }
  }
  std::size_t units() const override { return own_.size(); }
  const std::vector<VariantId>& variants_of(std::size_t unit) const override { return own_[unit]; }
  bool leaves_alone(std::size_t) const override { return true; }
  const UnitSet& leaving(VariantId v) const override { return leaving_[v]; }
  bool may_leave(VariantId, const UnitSet&) override { return true; }
  const UnitSet& blocking(VariantId) override { return none_; }
  double cost(VariantId v, const UnitSet& rest, VariantId) override {
    const auto there = [&](std::size_t place) {
      const std::size_t u = 7 * place % units();  // units side by side in the ring are not so by number
      return u == v || rest.contains(u);
    };
    double ends = 0;
    for (std::size_t p = 0; p < units(); ++p) ends += there(p) != there((p + 1) % units()) ? 1 : 0;
    return ends;
  }
  double least(VariantId) const override { return 0; }
  std::uint64_t classes(VariantId) const override { return 1; }
  double change() const override { return 0; }
  bool alike(VariantId, VariantId) const override { return true; }

 private:
  UnitSet none_{0};
  std::vector<UnitSet> leaving_;
  std::vector<std::vector<VariantId>> own_;
};

TEST(OrderSearch, TheBeamOpensARingInOnePlace) {
  for (const std::size_t units : {9u, 12u, 16u}) {
    Ring problem(units);
    Effort effort{400 * units};
    const Order found = beam(problem, whole(problem), effort);
    EXPECT_EQ(found.cost, 2.0 * static_cast<double>(units - 2)) << units;  // all states but the first and the last
  }
}

TEST(OrderSearch, TheBeamEndsWithAnOrderWhateverTheEffort) {
  for (const std::size_t units : {9u, 40u, 75u})
    for (const std::uint64_t each : {20u, 57u, 101u, 343u, 900u}) {
      Ring problem(units);
      Effort effort{each * units};
      EXPECT_LT(beam(problem, whole(problem), effort).cost, kForbidden) << units << " " << each;
    }
}

}  // namespace
}  // namespace dismantle::order
