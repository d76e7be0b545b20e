// A tree of poses is resumed when parts have left.
#include <gtest/gtest.h>

#include "dismantle/tolerant_walk/pose_tree.h"
#include "table.h"

namespace dismantle::tolerant_walk {
namespace {

using path::test::assembly_of;
using path::test::block;
using path::test::boxes;
using path::test::Table;

/// Part 0 on the slab that is part 1, between the walls that are parts 2 and 3.
struct TestScene {
  Table table{assembly_of({boxes({block(0, 0, 0, 1, 1, 1)}), boxes({block(-3, -3, -1, 4, 4, -0.01)}),
                           boxes({block(-2, 0, 0, -1, 1, 1)}), boxes({block(2, 0, 0, 3, 1, 1)})})};
  Parameters parameters;
  GeometryCache cache;
  RunContext context;
  Rng rng{1};
  PartId blamed = 2;
  std::size_t checked = 0;
  fake::RuleChecker checker{[this](const Path& path) {
    ++checked;
    fake::Ruling ruling;
    ruling.has_witness = true;
    ruling.part = 0, ruling.other = blamed;
    ruling.point = Eigen::Vector3d(0.5, 0.5, 0.5);
    ruling.instant = path.size() - 1;
    return ruling;
  }};

  PathQuery query(const std::vector<PartId>& fixed) {
    Scene scene;
    scene.moving.push_back({0, Pose{}});
    for (const PartId id : fixed) scene.fixed.push_back({id, Pose{}});
    return {table.assembly, *table.simulator, *table.prepared, scene, {}, 0.01, checker};
  }
  PoseTree tree(const PathQuery& query) { return PoseTree(parameters, query, context, rng, cache); }
};

Pose up(double z) { return {Eigen::Vector3d(0, 0, z), Eigen::Quaterniond::Identity()}; }

/// Branches stay cut unless the part that caused the cut has left.
TEST(PoseTreeResume, BranchesCutBecauseOfAPartGrowAgainWithoutIt) {
  for (const PartId blamed : {PartId{2}, PartId{3}}) {
    TestScene s;
    s.blamed = blamed;
    const PathQuery all = s.query({1, 2, 3}), fewer = s.query({1, 3});
    PoseTree tree = s.tree(all);
    const std::uint32_t a = tree.add(up(0.5), 0), b = tree.add(up(1.0), a), c = tree.add(up(0.7), 0);
    PathResult result;
    EXPECT_FALSE(tree.find_verified_path(b, result));
    EXPECT_GT(s.checked, 0U);
    ASSERT_TRUE(tree[b].cut);
    ASSERT_FALSE(tree[c].cut);
    PoseTree same = s.tree(all);
    same.resume(*tree.search_state());
    ASSERT_EQ(same.size(), tree.size());
    for (const std::uint32_t n : {a, b, c}) EXPECT_EQ(same[n].cut, tree[n].cut) << "no part has left";
    PoseTree freed = s.tree(fewer);
    freed.resume(*tree.search_state());
    ASSERT_EQ(freed.size(), tree.size());
    EXPECT_EQ(freed[b].cut, blamed == 3);
    EXPECT_FALSE(freed[c].cut);
    EXPECT_EQ(freed[b].parent, a);
    EXPECT_EQ(freed[b].pose.t, up(1.0).t);
    EXPECT_EQ(freed.spared(), tree.state_checks());
  }
}

/// Obstacles count only if they were met often enough.
TEST(PoseTreeResume, ResumesWhereItsObstaclesHaveLeft) {
  TestScene s;
  const PathQuery all = s.query({1, 2, 3});
  PoseTree tree = s.tree(all), other = s.tree(all);
  const auto bump = [](PoseTree& into, double x, int times) {
    for (int k = 0; k < times; ++k) EXPECT_FALSE(into.state_valid({{x, 0, 0}, Eigen::Quaterniond::Identity()}));
  };
  bump(tree, -1.5, 100);  // into part 2
  EXPECT_TRUE(tree.search_state()->obstacles_removed(s.query({1, 3}).scene, 0.1));
  EXPECT_FALSE(tree.search_state()->obstacles_removed(s.query({1, 2}).scene, 0.1));
  EXPECT_FALSE(tree.search_state()->obstacles_removed(all.scene, 0.1));
  bump(other, 1.5, 100);  // into part 3
  bump(other, -1.5, 5);
  EXPECT_FALSE(other.search_state()->obstacles_removed(s.query({1, 3}).scene, 0.1));
  EXPECT_TRUE(other.search_state()->obstacles_removed(s.query({1, 2}).scene, 0.1));
  EXPECT_TRUE(other.search_state()->obstacles_removed(s.query({1}).scene, 0.1));
}

}  // namespace
}  // namespace dismantle::tolerant_walk
