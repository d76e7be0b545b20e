// The steps to one part, compared with all orders of blocks on a lattice, which a search of its own finds.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "best_order/best_order.h"
#include "dismantle/testing/built_in_provers.h"
#include "dismantle/testing/run_rig.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {
namespace {

using Eigen::Vector3d;

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

using Corner = std::array<int, 3>;

/// A block on a lattice that was cut into boxes. With `angular`, some parts are several of them. With `tub`, the last part
/// stands around them, open at the top, where it may cover some of them; it never moves.
struct Lattice {
  static constexpr int kSize = 5;
  std::map<Corner, PartId> cells;
  std::vector<std::vector<fake::Box>> boxes;  // by part
  PartId parts = 0;
  Constraints constraints;

  static Lattice random(Rng& rng, bool angular, bool tub) {
    Lattice lattice;
    lattice.parts = tub ? 7 - static_cast<PartId>(rng.below(2)) : 3 + static_cast<PartId>(rng.below(6));
    std::vector<std::pair<Corner, Corner>> all{{{0, 0, 0}, {kSize, kSize, kSize}}};
    const std::size_t count = angular ? lattice.parts + 1 + rng.below(6) : lattice.parts;
    while (all.size() < count) {
      const std::size_t which = rng.below(all.size()), axis = std::min<std::uint64_t>(rng.below(5), 2);
      const int lo = all[which].first[axis], hi = all[which].second[axis];
      if (hi - lo < 2) continue;
      const int cut = lo + 1 + static_cast<int>(rng.below(static_cast<std::uint64_t>(hi - lo - 1)));
      all.push_back(all[which]);
      all[which].second[axis] = all.back().first[axis] = cut;
    }
    lattice.boxes.resize(lattice.parts);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const PartId part = k < lattice.parts ? static_cast<PartId>(k) : static_cast<PartId>(rng.below(lattice.parts));
      lattice.add(part, all[k].first, all[k].second);
    }
    if (!tub) return lattice;
    constexpr int n = kSize;
    const PartId part = lattice.parts++;
    lattice.boxes.emplace_back();
    lattice.constraints.base = {part};
    lattice.add(part, {-1, -1, -1}, {n + 1, n + 1, 0});
    lattice.add(part, {-1, -1, 0}, {0, n + 1, n});
    lattice.add(part, {n, -1, 0}, {n + 1, n + 1, n});
    lattice.add(part, {0, -1, 0}, {n, 0, n});
    lattice.add(part, {0, n, 0}, {n, n + 1, n});
    lattice.add(part, {-1, -1, n}, {n + 1, static_cast<int>(rng.below(2)), n + 1});
    return lattice;
  }

  void add(PartId part, const Corner& lo, const Corner& hi) {
    boxes[part].push_back({Vector3d(lo[0], lo[1], lo[2]), Vector3d(hi[0], hi[1], hi[2])});
    for (int x = lo[0]; x < hi[0]; ++x)
      for (int y = lo[1]; y < hi[1]; ++y)
        for (int z = lo[2]; z < hi[2]; ++z) cells[{x, y, z}] = part;
  }

  /// Parts have a gap between them.
  Assembly assembly() const {
    std::vector<std::pair<std::string, std::vector<fake::Box>>> all;
    for (const std::vector<fake::Box>& part : boxes) {
      all.push_back({"p" + std::to_string(all.size()), part});
      for (fake::Box& box : all.back().second) {
        box.lo += Vector3d::Constant(0.05);
        box.hi -= Vector3d::Constant(0.05);
      }
    }
    return fake::assembly_of(all);
  }

  /// Is a cell of `other` somewhere behind one of `part`, along the axis?
  bool blocks(PartId part, PartId other, int axis, int sign) const {
    for (const auto& [at, id] : cells) {
      if (id != part) continue;
      Corner next = at;
      for (int k = 0; k < kSize + 2; ++k) {
        next[axis] += sign;
        if (const auto cell = cells.find(next); cell != cells.end() && cell->second == other) return true;
      }
    }
    return false;
  }

  /// The fewest steps until the part is by itself, and of orders with so many steps the fewest changes of direction:
  /// breadth first over all sets of parts. None: it never is.
  std::optional<std::pair<unsigned, unsigned>> fewest_steps(PartId target) const {
    std::vector<std::array<unsigned, 6>> in_the_way(parts, std::array<unsigned, 6>{});  // sets of parts
    for (PartId id = 0; id < parts; ++id)
      for (int way = 0; way < 6; ++way)
        for (PartId other = 0; other < parts; ++other)
          if (other != id && blocks(id, other, way / 2, way % 2 == 0 ? 1 : -1)) in_the_way[id][way] |= 1U << other;
    std::map<std::pair<unsigned, int>, unsigned> layer{{{(1U << parts) - 1, -1}, 0}};  // present, last way: changes
    for (unsigned steps = 0; !layer.empty(); ++steps) {
      std::map<std::pair<unsigned, int>, unsigned> next;
      std::optional<unsigned> changes;
      for (const auto& [state, so_far] : layer) {
        const auto [present, last] = state;
        if ((present >> target & 1U) == 0 || std::popcount(present) == 1) changes = std::min(changes.value_or(so_far), so_far);
        for (PartId id = 0; id < parts; ++id)
          for (int way = 0; (present >> id & 1U) != 0 && way < 6; ++way) {
            if (contains(constraints.base, id) || (present & in_the_way[id][way]) != 0) continue;
            const unsigned now = so_far + (last >= 0 && last != way ? 1 : 0);
            const auto [entry, is_new] = next.try_emplace({present & ~(1U << id), way}, now);
            entry->second = std::min(entry->second, now);
          }
      }
      if (changes) return std::pair(steps, *changes);
      layer = std::move(next);
    }
    return std::nullopt;
  }
};

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
  BestOrderParams params;
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
    const Lattice lattice = Lattice::random(rng, trial % 3 == 1, trial % 5 != 0);
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
    BestOrderParams params;
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
