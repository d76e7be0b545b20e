// bfs with sdf_penalty and the verifier, on small solids.
#include <gtest/gtest.h>

#include "table.h"

namespace dismantle::bfs {
namespace {

using path::test::assembly_of;
using path::test::block;
using path::test::boxes;

/// A slider in a roofed slot. It leaves 1.5 along +x, then up through a hole in the roof.
Assembly l_slot() {
  const double c = 0.02;
  return assembly_of(
      {boxes({block(0, 0, 0, 1, 0.8, 0.6)}), boxes({block(-0.5, -0.5, -0.5, 3, 1.3, -c),              // floor
                                                    block(-0.5, -0.5, -c, -c, 1.3, 1),                // back
                                                    block(2.5 + c, -0.5, -c, 3, 1.3, 1),              // front
                                                    block(-c, -0.5, -c, 2.5 + c, -c, 1),              // sides
                                                    block(-c, 0.8 + c, -c, 2.5 + c, 1.3, 1),          //
                                                    block(-c, -c, 0.6 + c, 1.5 - c, 0.8 + c, 1)})});  // roof
}

struct Bench : path::test::Table {
  using Table::Table;
  PathResult plan(const std::vector<PartId>& moving, const ParamSet& given, const Budget& effort = {}) {
    return Table::plan("bfs", given, 0, effort, moving);
  }
};

TEST(BfsPhysics, SolvesAnLSlotInTwoMoves) {
  Bench bench(l_slot());
  const PathResult translation = bench.plan({0}, {{"motion", std::string("translation")}});
  ASSERT_EQ(translation.outcome(), Outcome::solved) << translation.message;
  EXPECT_EQ(translation.depth, 2u);
  for (const auto& instant : translation.path()->poses())
    EXPECT_EQ(instant[0].q.coeffs(), Eigen::Quaterniond::Identity().coeffs()) << "orientation is locked";
  double furthest = 0;
  for (const auto& instant : translation.path()->poses()) furthest = std::max(furthest, instant[0].t.x());
  EXPECT_GE(furthest, 1.45);
  EXPECT_GE(translation.path()->poses().back()[0].t.z(), 0.98);

  const PathResult automatic = bench.plan({0}, {});
  ASSERT_EQ(automatic.outcome(), Outcome::solved);
  ASSERT_EQ(automatic.path()->poses().size(), translation.path()->poses().size()) << "auto tries translation first";
  for (std::size_t k = 0; k < automatic.path()->poses().size(); ++k)
    EXPECT_EQ(automatic.path()->poses()[k][0].t, translation.path()->poses()[k][0].t);
}

TEST(BfsPhysics, DepthOneIsNotEnoughForAnLSlot) {
  Bench bench(l_slot());
  const ParamSet axes{{"diagonals", false}};
  EXPECT_EQ(bench.plan({0}, axes, {.max_depth = 1}).outcome(), Outcome::depth_limit);
  EXPECT_EQ(bench.plan({0}, axes, {.max_depth = 2}).outcome(), Outcome::solved);
}

/// A room of 1.2 x 1 x 0.8 with walls of 0.03, and a block in it with `play` on all six sides.
Assembly closed_box(double play) {
  const double w = 0.03;
  Mesh room = boxes({block(-0.6 - w, -0.5 - w, -0.4 - w, 0.6 + w, 0.5 + w, 0.4 + w)});
  const Mesh inner = boxes({block(-0.6, -0.5, -0.4, 0.6, 0.5, 0.4)});
  for (const auto& v : inner.vertices) room.vertices.push_back(v);
  for (const auto& t : inner.triangles) room.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  return assembly_of({boxes({block(-0.6 + play, -0.5 + play, -0.4 + play, 0.6 - play, 0.5 - play, 0.4 - play)}), room});
}

TEST(BfsPhysics, AClosedBoxWithThinWallsIsExhausted) {
  Bench bench(closed_box(0.02));
  for (const char* motion : {"translation", "rotation", "auto"}) {
    const PathResult r = bench.plan({0}, {{"motion", std::string(motion)}}, {.max_steps = 60'000});
    EXPECT_EQ(r.outcome(), Outcome::exhausted) << motion << ", " << r.stats.steps << " steps";
    EXPECT_EQ(r.stats.refused, 0u) << "the physics holds by itself";
    EXPECT_EQ(r.blocked_by, std::vector<PartId>{1});
    EXPECT_FALSE(r.path());
  }
}

TEST(BfsPhysics, NothingLeavesAClosedBoxHoweverLoose) {
  Bench bench(closed_box(0.15));
  for (const char* motion : {"translation", "rotation"}) {
    const PathResult r = bench.plan({0}, {{"motion", std::string(motion)}}, {.max_steps = 6'000});
    EXPECT_FALSE(is_success(r.outcome())) << motion;
    EXPECT_EQ(r.stats.refused, 0u) << "the physics holds by itself";
  }
}

TEST(BfsPhysics, ADepthLimitLimitsSimulatedSteps) {
  Bench bench(closed_box(0.15));
  for (const unsigned depth : {1u, 2u, 3u}) {
    const PathResult r = bench.plan({0}, {}, {.max_depth = depth});
    EXPECT_EQ(r.outcome(), Outcome::depth_limit) << depth;
    // 2000 per level for translation, and from the second level on as many with rotation. The current run is completed.
    EXPECT_LE(r.stats.steps, (depth == 1 ? 1u : 2u) * 2000u * depth + 2 * 500) << depth;
  }
}

TEST(BfsPhysics, PartsThatMoveTogetherDoNotBlockEachOther) {
  // Two stacked plates in a tube with a floor leave together; only the tube blocks them.
  const double c = 0.02;
  Bench bench(
      assembly_of({boxes({block(-0.5, -0.5, 0, 0.5, 0.5, 0.2)}), boxes({block(-0.5, -0.5, 0.2, 0.5, 0.5, 0.4)}),
                   boxes({block(-0.8, -0.8, -0.3, 0.8, 0.8, -c), block(-0.8, -0.8, -c, -0.5 - c, 0.8, 0.7),
                          block(0.5 + c, -0.8, -c, 0.8, 0.8, 0.7), block(-0.5 - c, -0.8, -c, 0.5 + c, -0.5 - c, 0.7),
                          block(-0.5 - c, 0.5 + c, -c, 0.5 + c, 0.8, 0.7)})}));
  const PathResult both = bench.plan({0, 1}, {});
  ASSERT_EQ(both.outcome(), Outcome::solved);
  for (const PartId p : both.blocked_by) EXPECT_EQ(p, 2u) << "only what stay fixed blocks";
  const PathResult lower = bench.plan({0}, {{"motion", std::string("translation")}}, {.max_steps = 60'000});
  EXPECT_EQ(lower.outcome(), Outcome::exhausted);
  ASSERT_FALSE(lower.blocked_by.empty());
  EXPECT_NE(std::find(lower.blocked_by.begin(), lower.blocked_by.end(), 1u), lower.blocked_by.end());
}

}  // namespace
}  // namespace dismantle::bfs
