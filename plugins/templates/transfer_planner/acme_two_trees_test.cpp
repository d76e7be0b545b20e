// Tests of acme.two_trees beyond the laws of its kind, which `dismantle plugins check` tests.
#include <gtest/gtest.h>

#include "dismantle/host/registry.h"
#include "dismantle/testing/fake_planning.h"
#include "dismantle/verification/verifier.h"

namespace {

using dismantle::Pose;

/// Moves a block from one side of a wall to the other and rotates it by `turn`.
dismantle::PathResult carry(double turn, std::int64_t max_checks, std::uint64_t seed) {
  const auto assembly = dismantle::fake::assembly_of({{"wall", {{{-0.2, -2, -2}, {0.2, 2, 2}}}}, {"block", {{{-1, -0.3, -0.3}, {1, 0.3, 0.3}}}}});
  dismantle::Registry registry;
  registry.scan();
  registry.load(PLUGIN_FILE);
  const auto simulator = registry.create<dismantle::Simulator>("fcl");
  const auto planner = registry.create<dismantle::TransferPlanner>("acme.two_trees", {{"max_checks", max_checks}});
  dismantle::RunContext context;
  context.rng = dismantle::Rng(seed);
  const auto prepared = simulator->prepare(assembly, 0.01, context);
  const dismantle::Scene scene{{{1, Pose{{-3, 0, 0}, Eigen::Quaterniond::Identity()}}}, {{0, Pose{}}}};
  const std::vector<Pose> goal = {{{3, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()))}};
  const dismantle::Verifier verifier(assembly, dismantle::VerifyOptions{});
  const dismantle::fake::RuleChecker checker([&](const dismantle::Path& path) {
    dismantle::fake::Ruling ruling;
    ruling.accept = verifier.check_motion({1}, scene.fixed, path).valid;
    return ruling;
  });
  const dismantle::TransferQuery query{assembly, *simulator, *prepared, scene, goal, Eigen::Vector3d::UnitZ(), {}, 0.01, checker};
  return planner->plan(query, context);
}

TEST(AcmeTwoTrees, GoesAroundAWallTurnedOrNot) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    for (const double turn : {0.0, 1.5, -2.5}) {
      const auto result = carry(turn, 30'000, seed);
      ASSERT_EQ(result.outcome(), dismantle::Outcome::solved) << seed << " " << turn << " " << result.message;
      EXPECT_GT(result.depth, 1U) << "the wall is in the straight way";
      EXPECT_LE(result.stats.state_checks, 30'000U);
    }
}

TEST(AcmeTwoTrees, KeepsToItsOwnLimit) {
  const auto result = carry(0, 20, 1);
  EXPECT_EQ(result.outcome(), dismantle::Outcome::timeout);
  EXPECT_LE(result.stats.state_checks, 20U);
}

}  // namespace
