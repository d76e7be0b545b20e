// The planner with sdf_penalty and the verifier, on mazes and linked rings in random orientations.
#include <gtest/gtest.h>

#include <algorithm>

#include "narrow_places.h"
#include "table.h"

namespace dismantle::tunnel_forest {
namespace {

using namespace path::test;

Pose random_pose(Rng& rng) { return {Vector3d(rng.normal(), rng.normal(), rng.normal()), random_turn(rng)}; }

/// A pin in a box with corridors. It leaves along +x, +y, -x, then through the roof.
std::vector<Mesh> corridors() {
  const double c = 0.03;
  return {boxes({block(0, 0, 0, 0.6, 0.6, 0.6)}),
          boxes({block(-0.5, -0.5, -0.5, 3.5, 2.5, -c),          // floor
                 block(-0.5, -0.5, -c, 3.5, -c, 1.2),            // walls
                 block(-0.5, 2 + c, -c, 3.5, 2.5, 1.2),          //
                 block(-0.5, -c, -c, -c, 2 + c, 1.2),            //
                 block(3 + c, -c, -c, 3.5, 2 + c, 1.2),          //
                 block(-c, 0.6 + c, -c, 2.4 - c, 1.4 - c, 0.7),  // between the corridors
                 block(-c, -c, 0.6 + c, 3 + c, 1.4 - c, 1.2),    // roof, open over the end
                 block(0.6 + c, 1.4 - c, 0.6 + c, 3 + c, 2 + c, 1.2)})};
}

TEST(TunnelForest, SolvesTurnedCorridors) {
  Rng rng(11);
  for (std::uint64_t k = 1; k <= 4; ++k) {
    Table table(assembly_of(corridors(), k == 1 ? Pose{} : random_pose(rng)));
    const PathResult r = table.plan("tunnel_forest", {{"motion", std::string("translation")}}, k, 100'000);
    EXPECT_EQ(r.outcome(), Outcome::solved) << k;
    EXPECT_GE(r.depth, 4u);
    EXPECT_EQ(r.stats.extra.at("tunnels"), 0) << "tunnels exist in SE(3) only";
    for (const auto& instant : r.path()->poses())
      EXPECT_LT(angle_between(instant[0].q, Eigen::Quaterniond::Identity()), 1e-9);
  }
}

TEST(TunnelForest, TakesARingOffATurnedOpenOne) {
  Rng rng(12);
  for (std::uint64_t k = 1; k <= 3; ++k) {
    Table table(assembly_of({linked_ring(), open_ring(0.6)}, k == 1 ? Pose{} : random_pose(rng)));
    const PathResult r = table.plan("tunnel_forest", {{"motion", std::string("rotation")}}, k, 300'000);
    EXPECT_EQ(r.outcome(), Outcome::solved) << k;
    EXPECT_GT(r.stats.extra.at("tunnels"), 0);
  }
}

/// The gap is too narrow for the bar, and there is no other exit.
TEST(TunnelForest, ARingThatCannotLeaveDoesNot) {
  Table table(assembly_of({linked_ring(), open_ring(0.4)}));
  const PathResult r = table.plan("tunnel_forest", {}, 1, 40'000);
  EXPECT_EQ(r.outcome(), Outcome::timeout);
  EXPECT_FALSE(r.path());
  ASSERT_EQ(r.blocked_by.size(), 1u);
  EXPECT_EQ(r.blocked_by[0], 1u);
  EXPECT_EQ(r.best_pose.size(), 1u);
}

TEST(TunnelForest, DepthIsABudgetThatDoubles) {
  Table table(assembly_of({linked_ring(), open_ring(0.4)}));
  for (unsigned depth = 1; depth <= 3; ++depth) {
    const PathResult r = table.plan("tunnel_forest", {{"level_steps", std::int64_t{1000}}}, 1, 0, depth);
    EXPECT_EQ(r.outcome(), Outcome::depth_limit);
    const double limit = 1000 * std::ldexp(1.0, static_cast<int>(depth) - 1);
    EXPECT_GE(r.stats.steps, limit);
    EXPECT_LE(r.stats.steps, limit + 100);
  }
}

TEST(TunnelForest, WithoutTunnelsOnlyTheTreeAtTheStartGrows) {
  Table table(assembly_of({linked_ring(), open_ring(0.6)}));
  const PathResult r =
      table.plan("tunnel_forest", {{"motion", std::string("rotation")}, {"tunnels", std::int64_t{0}}}, 1, 5'000);
  EXPECT_EQ(r.stats.extra.at("tunnels"), 0);
}

}  // namespace
}  // namespace dismantle::tunnel_forest
