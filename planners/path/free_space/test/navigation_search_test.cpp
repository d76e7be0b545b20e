// A small plate in a box with walls across it leaves along the navigation function, where contact search fails.
#include "dismantle/free_space/navigation_search.h"

#include <gtest/gtest.h>

#include "helix.h"
#include "table.h"

namespace dismantle::free_space {
namespace {

using path::test::assembly_of;
using path::test::block;
using path::test::boxes;
using path::test::Table;

constexpr double kWidth = 3, kHeight = 1;

/// A box along x with inner width and height as above, closed at x = 0, open at x = `length`.
std::vector<Aabb> box_of(double length) {
  const double t = 0.5;
  return {block(-t, -t, -t, 0, kWidth + t, kHeight + t), block(0, -t, -t, length, 0, kHeight + t),
          block(0, kWidth, -t, length, kWidth + t, kHeight + t), block(0, 0, -t, length, kWidth, 0),
          block(0, 0, kHeight, length, kWidth, kHeight + t)};
}

/// Walls with a gap at alternate corners. The plate lies in the corner that is furthest from outside. `others` are more
/// parts.
Assembly maze(double gap, const std::vector<std::vector<Aabb>>& others = {}) {
  std::vector<Aabb> walls = box_of(6);
  const double t = 0.1;
  for (int k = 0; k < 4; ++k) {
    const double x = 1.2 * (k + 1);
    const bool right = k % 2 == 0, upper = k / 2 % 2 == 0;
    walls.push_back(right ? block(x, 0, 0, x + t, kWidth - gap, kHeight) : block(x, gap, 0, x + t, kWidth, kHeight));
    if (gap > 0) {
      const double y0 = right ? kWidth - gap : 0, y1 = right ? kWidth : gap;
      walls.push_back(upper ? block(x, y0, 0, x + t, y1, kHeight - gap) : block(x, y0, gap, x + t, y1, kHeight));
    }
  }
  std::vector<Mesh> parts{boxes({block(0.1, 0.1, 0.01, 0.7, 0.7, 0.06)}), boxes(walls)};
  for (const auto& other : others) parts.push_back(boxes(other));
  return assembly_of(parts, {Eigen::Vector3d(0.3, 0.2, 0.1), Eigen::Quaterniond(0.9, 0.3, -0.2, 0.25).normalized()});
}

ParamSet guided_with(std::int64_t patience, std::int64_t state_checks = 4000) {
  return path::test::guided({{"navigation_tree.patience", patience},
                             {"tolerant_rrt.state_checks", state_checks},
                             {"tolerant_rrt.level_state_checks", static_cast<double>(state_checks) / 128}},
                            {"tunnel_forest"});
}

TEST(NavigationSearch, TakesAPlateOutOfAMaze) {
  Table table(maze(0.75));
  const PathResult without = table.plan("guided", guided_with(0), 1, 0, 2);
  EXPECT_FALSE(is_success(without.outcome())) << "the test needs an assembly that the other planners do not solve";
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const PathResult with = table.plan("guided", guided_with(4000), seed, 0, 2);
    ASSERT_EQ(with.outcome(), Outcome::solved) << with.message;
    EXPECT_TRUE(table.verifier.check_motion({0}, {{1, Pose{}}}, with.path()->poses()).valid);
    const PathResult again = table.plan("guided", guided_with(4000), seed, 0, 2);
    ASSERT_EQ(again.path()->poses().size(), with.path()->poses().size());
    EXPECT_TRUE(again.path()->poses().back()[0].t == with.path()->poses().back()[0].t);
  }
}

/// Part 2 is a grate in the last gap but one: balls pass through it, the plate does not. Part 3 is a block beside the
/// box that nothing touches. When the grate is removed, the search resumes; when the block is removed, the plate is as
/// blocked as before, and the search starts again.
TEST(NavigationSearch, ResumesWhenItsObstacleHasLeft) {
  const double a = 0.75, play = 0.005, hole = 0.3;
  const double x0 = 3.6 + play, x1 = 3.7 - play, y0 = kWidth - a + play, y1 = kWidth - play, z0 = play, z1 = a - play;
  Table table(maze(a, {{block(x0, y0, z0, x1, y0 + 0.2, z1), block(x0, y0 + 0.2 + hole, z0, x1, y1, z1),
                        block(x0, y0 + 0.2, z0, x1, y0 + 0.2 + hole, z0 + 0.2),
                        block(x0, y0 + 0.2, z0 + 0.2 + hole, x1, y0 + 0.2 + hole, z1)},
                       {block(1, 5, 0, 2, 6, 1)}}));
  const ParamSet few = guided_with(1000, 1000);
  double nodes = 0, nodes_restarted = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const auto plan = [&](const std::vector<PartId>& left, const SearchState* reached) {
      return table.plan("guided", few, seed, {.max_depth = 3}, {0}, left, reached);
    };
    const PathResult shut = plan({}, nullptr);
    ASSERT_FALSE(is_success(shut.outcome()));
    ASSERT_NE(shut.state, nullptr);
    const PathResult open = plan({2}, shut.state.get()), open_restarted = plan({2}, nullptr);
    ASSERT_EQ(open.outcome(), Outcome::solved) << open.message;
    EXPECT_TRUE(table.verifier.check_motion({0}, {{1, Pose{}}, {3, Pose{}}}, open.path()->poses()).valid);
    EXPECT_EQ(open.path()->poses().front()[0].t, Eigen::Vector3d::Zero());
    EXPECT_GT(open.stats.extra.at("navigation_tree_resumed_nodes"), 0);
    EXPECT_EQ(open.stats.extra.at("navigation_tree_spared"), shut.stats.extra.at("navigation_tree_state_checks"));
    nodes += open.stats.extra.at("navigation_tree_nodes") - open.stats.extra.at("navigation_tree_resumed_nodes");
    nodes_restarted += open_restarted.stats.extra.at("navigation_tree_nodes");
    const PathResult stuck = plan({3}, shut.state.get());
    EXPECT_FALSE(is_success(stuck.outcome()));
    EXPECT_FALSE(stuck.stats.extra.contains("navigation_tree_resumed_nodes"));
    EXPECT_FALSE(stuck.stats.extra.contains("tolerant_rrt_resumed_nodes"));
  }
  EXPECT_LT(nodes, nodes_restarted);
}

/// An idle thread may run the next member of the portfolio ahead of time.
TEST(NavigationSearch, TheSameWhereOthersHelp) {
  const ParamSet few = guided_with(500, 1000);
  for (const double gap : {0.75, 0.0})
    for (const unsigned depth : {2U, 3U, 4U}) {
      Table table(maze(gap));
      const PathResult alone = table.plan("guided", few, 1, 0, depth);
      table.executor = std::make_shared<Executor>(3);
      const PathResult helped = table.plan("guided", few, 1, 0, depth);
      EXPECT_EQ(helped.outcome(), alone.outcome());
      EXPECT_EQ(helped.stats, alone.stats);
      EXPECT_EQ(helped.blocked_by, alone.blocked_by);
      EXPECT_EQ(helped.message, alone.message);
      ASSERT_EQ(helped.path().has_value(), alone.path().has_value());
      if (!alone.path()) continue;
      ASSERT_EQ(helped.path()->poses().size(), alone.path()->poses().size());
      for (std::size_t k = 0; k < alone.path()->poses().size(); ++k)
        EXPECT_EQ(helped.path()->poses()[k][0].t, alone.path()->poses()[k][0].t);
    }
}

TEST(NavigationSearch, GivesUpImmediatelyWithoutARoute) {
  Table table(maze(0));
  const PathResult r = table.plan("guided", guided_with(4000), 1, 0, 2);
  EXPECT_FALSE(is_success(r.outcome()));
  EXPECT_FALSE(r.stats.extra.contains("navigation_tree_state_checks"));
}

/// A ring on a spool with a little play is held, however much free space is around it.
TEST(NavigationSearch, GivesUpSoonWhereThereIsOnlyPlay) {
  const double play = 0.002, x = 2, y = 1.5, z = 0.4, in = 0.2, out = 0.6, high = 0.1;
  std::vector<Aabb> fixed = box_of(6);
  fixed.push_back(block(x - in, y - in, 0, x + in, y + in, 0.8));
  fixed.push_back(block(x - 0.4, y - 0.4, z - 0.1, x + 0.4, y + 0.4, z));
  fixed.push_back(block(x - 0.4, y - 0.4, z + high, x + 0.4, y + 0.4, z + high + 0.1));
  const double a = in + play, lo = z + play, hi = z + high - play;
  const std::vector<Aabb> ring{
      block(x - out, y - out, lo, x - a, y + out, hi), block(x + a, y - out, lo, x + out, y + out, hi),
      block(x - a, y - out, lo, x + a, y - a, hi), block(x - a, y + a, lo, x + a, y + out, hi)};
  Table table(assembly_of({boxes(ring), boxes(fixed)}));
  const PathResult r = table.plan("guided", guided_with(4000), 1, 0, 2);
  EXPECT_FALSE(is_success(r.outcome()));
  EXPECT_LT(r.stats.extra.at("navigation_tree_state_checks"), 500);
}

TEST(NavigationSearch, GivesUpWhereTheBodyDoesNotFit) {
  Table table(maze(0.3));
  const PathResult r = table.plan("guided", guided_with(1000), 1, 0, 2);
  EXPECT_FALSE(is_success(r.outcome()));
  EXPECT_GT(r.stats.extra.at("navigation_tree_state_checks"), 0);
}

/// Two holes in one wall. A ball passes through the near one, the plate does not.
TEST(NavigationSearch, TakesADetourWhereItIsStuck) {
  std::vector<Aabb> walls = box_of(4);
  const double x = 1.4, t = 0.1, s = 0.3;
  walls.push_back(block(x, 0, 0, x + t, 0.3, kHeight));
  walls.push_back(block(x, 0.3, s, x + t, 0.3 + s, kHeight));
  walls.push_back(block(x, 0.3 + s, 0, x + t, kWidth - 0.8, kHeight));
  walls.push_back(block(x, kWidth - 0.8, 0.8, x + t, kWidth, kHeight));
  walls.push_back(block(0.8, 1.2, 0, 0.9, kWidth, 0.5));  // makes the route to the other one longer
  Table table(assembly_of({boxes({block(0.1, 0.1, 0.01, 0.7, 0.7, 0.06)}), boxes(walls)}));
  const PathResult r = table.plan("guided", guided_with(4000), 1, 0, 2);
  ASSERT_TRUE(r.stats.extra.contains("navigation_tree_detours")) << "contact search alone must not solve it";
  EXPECT_EQ(r.outcome(), Outcome::solved) << r.message;
  EXPECT_GE(r.stats.extra.at("navigation_tree_detours"), 1);
}

/// A helical wire in front of a hole that is narrower than its coil: only a screw motion takes it out.
struct SpringInABox {
  static constexpr double kWire = 0.03, kHole = 0.5, kWall = 0.06, kAt = 1.8;
  Mesh spring, fixed, wall;
  Assembly assembly;

  /// `sunk`: depth of the wire in the bottom of the box.
  explicit SpringInABox(double sunk) {
    const path::test::Helix wound{.radius = 0.4, .pitch = 0.7, .wire = kWire, .turns = 2};
    spring = path::test::helix(wound);
    for (auto& v : spring.vertices) v += Eigen::Vector3d(0.02 - sunk + kWire, 1.5, 0.5);
    const double x0 = kAt, x1 = kAt + kWall, y0 = 1.5 - 0.5 * kHole, y1 = y0 + kHole, z0 = 0.25, z1 = z0 + kHole;
    const std::vector<Aabb> around{block(x0, 0, 0, x1, y0, kHeight), block(x0, y1, 0, x1, kWidth, kHeight),
                                   block(x0, y0, 0, x1, y1, z0), block(x0, y0, z1, x1, y1, kHeight)};
    std::vector<Aabb> all = box_of(2.4);
    all.insert(all.end(), around.begin(), around.end());
    fixed = boxes(all);
    wall = boxes(around);
    assembly = assembly_of({spring, fixed});
    const double overlap = penetration_depth(spring, Pose{}, fixed, Pose{}, 1e-4);
    if (overlap > 0) assembly.overlaps.push_back({0, 1, overlap});
  }
};

TEST(NavigationSearch, ScrewsASpringThroughAHole) {
  Table table(SpringInABox(0).assembly);
  int solved = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const PathResult r = table.plan("guided", guided_with(4000), seed, 0, 3);
    if (is_success(r.outcome())) ++solved;
  }
  EXPECT_GE(solved, 2);
}

/// The spring is sunk into the bottom by more than the thickness of the wall. Where that overlap is allowed everywhere,
/// it could leave through the wall; it does not.
TEST(NavigationSearch, DoesNotTakeAnOverlapThroughAWall) {
  const SpringInABox scene(0.07);
  ASSERT_GT(scene.assembly.initial_overlap(0, 1), 0.5 * SpringInABox::kWall);
  Table table(scene.assembly);
  int solved = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const PathResult r = table.plan("guided", guided_with(4000), seed, 0, 3);
    if (!is_success(r.outcome())) continue;
    ++solved;
    const DepthBody spring(scene.spring), wall(scene.wall);
    for (const auto& instant : r.path()->poses())
      EXPECT_LT(penetration_depth(spring, instant[0], wall, Pose{}, 1e-3), 0.012);
  }
  EXPECT_GE(solved, 2);
}

}  // namespace
}  // namespace dismantle::free_space
