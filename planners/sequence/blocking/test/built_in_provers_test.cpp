// The planner with the provers of this project, on parts that are known to be inseparable.
#include "dismantle/testing/built_in_provers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/testing/held_shapes.h"
#include "run_blocking.h"

namespace dismantle {
namespace {

RunResult prove_apart(const Assembly& assembly, unsigned threads = 1, const RunOptions& options = {}) {
  return fake::take_apart(assembly, threads, options, &fake::helpless, fake::built_in_provers());
}

/// Blocks in casings, side by side.
Assembly cased_pairs(int count) {
  const shapes::Cased held{{0.5, 0.4, 0.3}, 0.02, 0.1, 0.15};
  std::vector<Mesh> parts;
  for (int k = 0; k < count; ++k) {
    const Pose there = shapes::shift({3.0 * k, 0, 0});
    parts.push_back(shapes::moved(held.around(), there));
    parts.push_back(shapes::moved(held.block(), there));
  }
  return shapes::assembly_of(parts);
}

TEST(BlockingWithProvers, EachOfSeveralPairsIsProvedInseparable) {
  RunResult r = prove_apart(cased_pairs(3), 2);
  EXPECT_EQ(r.outcome, Outcome::infeasible);
  EXPECT_EQ(r.plan.disassembly.size(), 2u) << "the pairs themselves part";
  ASSERT_EQ(r.plan.unsolved.size(), 6u);
  for (const auto& u : r.plan.unsolved) EXPECT_NE(u.message.find("as rigid bodies"), std::string::npos) << u.message;
}

TEST(BlockingWithProvers, InseparablePartsAreReported) {
  using shapes::box;
  Mesh tray = box({-3, -3, -2}, {3, 3, -1});
  for (const double s : {-1.0, 1.0}) {
    shapes::append(tray, box({std::min(2 * s, 3 * s), -3, -0.99}, {std::max(2 * s, 3 * s), 3, 2}));
    shapes::append(tray, box({-1.99, std::min(2 * s, 3 * s), -0.99}, {1.99, std::max(2 * s, 3 * s), 2}));
  }
  for (const double opening : {0.3, 0.95}) {
    const Assembly assembly =
        shapes::assembly_of({tray, shapes::can(1, 0.6, 0.2, opening), shapes::tube(0.4, 0.8, -0.1, 0.1, 48),
                             box({-0.5, -0.5, 0.7}, {0.5, 0.5, 1})});
    RunOptions options;
    options.constraints.base = {0};  // otherwise the tray is removed from the two
    RunResult r = prove_apart(assembly, 1, options);
    if (opening > 0.8) {
      EXPECT_EQ(r.outcome, Outcome::solved) << "the ring fits through";
      continue;
    }
    EXPECT_EQ(r.outcome, Outcome::infeasible);
    ASSERT_EQ(r.plan.disassembly.size(), 2u);
    EXPECT_EQ(r.plan.disassembly[1].separates[0].size(), 2u);
    ASSERT_EQ(r.plan.unsolved.size(), 2u);
    for (const auto& u : r.plan.unsolved) {
      EXPECT_NE(u.message.find("hold each other"), std::string::npos) << u.message;
      EXPECT_EQ(u.blocked_by, std::vector<std::string>{u.part == "part1" ? "part2" : "part1"});
    }
  }
}

TEST(BlockingWithProvers, AfterAllSearchesTwoOfNoKnownShapeAreProvedInseparable) {
  for (const double rim : {0.1, -0.01}) {
    const shapes::Cased held{{0.5, 0.4, 0.3}, 0.02, rim, 0.15};
    const Assembly assembly =
        shapes::assembly_of({held.around(), held.block(), shapes::box({-0.2, -0.2, 0.5}, {0.2, 0.2, 0.7})});
    RunResult r = prove_apart(assembly);
    ASSERT_FALSE(r.plan.disassembly.empty()) << "the loose one leaves";
    if (rim < 0) {
      EXPECT_EQ(r.outcome, Outcome::solved);
      continue;
    }
    EXPECT_EQ(r.outcome, Outcome::infeasible);
    EXPECT_GT(r.counts.attempts, 0) << "the proof spares no search";
    ASSERT_EQ(r.plan.unsolved.size(), 2u);
    for (const auto& u : r.plan.unsolved) {
      EXPECT_NE(u.message.find("as rigid bodies"), std::string::npos) << u.message;
      EXPECT_EQ(u.blocked_by, std::vector<std::string>{u.part == "part0" ? "part1" : "part0"});
    }
  }
}

TEST(BlockingWithProvers, AfterAnUnsuccessfulSearchAFlatPieceIsProvedToStayInItsChamber) {
  const Mesh can = shapes::can_with_window(1, 0.6, 0.3, 0.3, 6), disc = shapes::tube(0, 0.9, -0.05, 0.05, 48);
  RunResult r = prove_apart(shapes::assembly_of({can, disc, shapes::box({-0.1, -0.1, 0.61}, {0.1, 0.1, 0.9})}));
  EXPECT_EQ(r.outcome, Outcome::infeasible);
  EXPECT_EQ(r.plan.disassembly.size(), 1u) << "the loose one leaves";
  EXPECT_GT(r.counts.attempts, 0);
  ASSERT_EQ(r.plan.unsolved.size(), 2u);
  for (const auto& u : r.plan.unsolved) EXPECT_NE(u.message.find("flat disc"), std::string::npos) << u.message;
}

TEST(BlockingWithProvers, AfterAllSearchesThreeAreProvedInseparableTogether) {
  const shapes::Keyed keyed{.play = 0.003};
  RunResult r = prove_apart(shapes::assembly_of({keyed.slab(), keyed.tray(), keyed.block()}));
  EXPECT_EQ(r.outcome, Outcome::exhausted);
  EXPECT_TRUE(r.plan.disassembly.empty());
  EXPECT_GT(r.counts.attempts, 0) << "the proof spares no search";
  ASSERT_EQ(r.plan.unsolved.size(), 3u);
  for (const auto& u : r.plan.unsolved) {
    EXPECT_NE(u.message.find("hold each other in place"), std::string::npos) << u.message;
    EXPECT_EQ(u.blocked_by.size(), 2u);
    EXPECT_EQ(std::count(u.blocked_by.begin(), u.blocked_by.end(), u.part), 0);
  }
}

}  // namespace
}  // namespace dismantle
