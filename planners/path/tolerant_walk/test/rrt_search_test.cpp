// A peg with a bead wider than its hole leaves exactly when the bead is within the tolerance.
#include "dismantle/tolerant_walk/rrt_search.h"

#include <gtest/gtest.h>

#include "table.h"

namespace dismantle::tolerant_walk {
namespace {

using Eigen::Vector3d;
using path::test::assembly_of;
using path::test::block;
using path::test::boxes;
using path::test::moved;
using path::test::Table;

/// A frame around a square hole of 1 x 1 with a closed bottom. In it is a peg with a bead on two sides; the hole has a
/// groove for the bead below the frame's upper edge.
Assembly snapped(double bead, const Pose& turned) {
  const double w = 1.5, g = 0.5 + bead + 0.02, lo = 0.4, hi = 0.6;
  std::vector<Aabb> frame{block(-w, -w, -0.5, w, w, 0)};
  const auto ring = [&](double inner, double z0, double z1) {
    frame.push_back(block(-w, -w, z0, w, -inner, z1));
    frame.push_back(block(-w, inner, z0, w, w, z1));
    frame.push_back(block(-w, -inner, z0, -inner, inner, z1));
    frame.push_back(block(inner, -inner, z0, w, inner, z1));
  };
  ring(0.5, 0, lo);
  ring(g, lo, hi);
  ring(0.5, hi, 0.75);
  const double p = 0.48, b = 0.5 + bead;
  return assembly_of(
      {boxes({block(-p, -p, 0.01, p, p, 0.9), block(-b, -0.3, lo + 0.02, b, 0.3, hi - 0.02)}), boxes(frame)}, turned);
}

TEST(TolerantRrt, TakesOutWhatSnapsWithinTheTolerance) {
  Table table(snapped(0.004, Pose{}));
  const PathResult r = table.plan("tolerant_rrt", {{"state_checks", std::int64_t{100'000}}}, 1, 0);
  ASSERT_EQ(r.outcome(), Outcome::solved) << r.message;
  EXPECT_GE(table.checked, 1U);
  const MotionCheck check = table.verifier.check_motion({0}, {{1, Pose{}}}, r.path()->poses());
  EXPECT_TRUE(check.valid);
  EXPECT_GT(check.max_penetration, 1e-3) << "it used the tolerance";
}

TEST(TolerantRrt, NeverTakesOutWhatSnapsDeeper) {
  Table table(snapped(0.03, Pose{}));
  const PathResult r = table.plan("tolerant_rrt", {{"state_checks", std::int64_t{1500}}}, 1, 0);
  EXPECT_TRUE(r.outcome() == Outcome::depth_limit || r.outcome() == Outcome::exhausted);
  EXPECT_FALSE(r.path());
  ASSERT_FALSE(r.blocked_by.empty());
  EXPECT_EQ(r.blocked_by.front(), 1U);
}

TEST(TolerantRrt, KeepsToItsBudget) {
  Table table(snapped(0.03, Pose{}));
  const PathResult r = table.plan("tolerant_rrt", {}, 1, 500);
  EXPECT_EQ(r.outcome(), Outcome::timeout);
  EXPECT_GE(r.stats.state_checks, 500u);
  EXPECT_LE(r.stats.state_checks, 500u + 400u);  // an extension is not interrupted
}

TEST(TolerantRrt, IsWhatGuidedComesToWhenContactSearchFails) {
  Table table(snapped(0.03, Pose{}));
  const auto plan = [&](unsigned depth) {
    const ParamSet few = path::test::guided(
        {{"tolerant_rrt.state_checks", std::int64_t{4000}}, {"tolerant_rrt.level_state_checks", 31.25}});
    return table.plan("guided", few, 1, 0, depth);
  };
  EXPECT_FALSE(plan(2).stats.extra.contains("tolerant_rrt_state_checks")) << "shallow searches are for many parts";
  const PathResult deep = plan(6);
  EXPECT_FALSE(is_success(deep.outcome()));
  EXPECT_GE(deep.stats.extra.at("tolerant_rrt_state_checks"), 1000);
  EXPECT_LE(deep.stats.extra.at("tolerant_rrt_state_checks"), 1000 + 400);
}

TEST(TolerantRrt, SharesTheBudgetOfGuidedUnderADepthLimit) {
  Table table(snapped(0.03, Pose{}));
  const ParamSet whole = path::test::guided(
      {{"tolerant_rrt.state_checks", std::int64_t{100'000}}, {"tolerant_rrt.level_state_checks", 781.25}});
  const PathResult free = table.plan("guided", whole, 1, 0, 3);
  const double pushes = free.stats.cost - free.stats.extra.at("tolerant_rrt_cost");
  const auto budget = static_cast<std::uint64_t>(pushes) + 700;
  const PathResult r = table.plan("guided", whole, 1, budget, 3);
  EXPECT_EQ(r.outcome(), Outcome::timeout) << "a search that ran out of steps is not exhausted";
  const double used = r.stats.cost;
  EXPECT_GE(used, static_cast<double>(budget));
  ASSERT_GT(pushes, 200) << "else what they used would not show";
  EXPECT_LE(used, static_cast<double>(budget) + 100);
}

}  // namespace
}  // namespace dismantle::tolerant_walk
