// Ways out of free space: they get shorter, never lead through a wall, and there is none where all is closed.
#include "dismantle/free_space/ways_out.h"

#include <gtest/gtest.h>

#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/run_context.h"
#include "solids.h"

namespace dismantle::free_space {
namespace {

using path::test::assembly_of;
using path::test::block;
using path::test::boxes;

constexpr std::size_t kCells = 60'000;

std::vector<PlacedPart> all_of(const Assembly& assembly) {
  std::vector<PlacedPart> fixed;
  for (const auto& part : assembly.parts) fixed.push_back({part.id, Pose{}});
  return fixed;
}

/// A hollow cube of edge 4 with walls 0.2 thick; a hole of that width through the one at +x.
Mesh hollow(double hole) {
  const double w = 2, i = 1.8, h = 0.5 * hole;
  std::vector<Aabb> walls{block(-w, -w, -w, -i, w, w), block(-i, -w, -w, i, -i, w), block(-i, i, -w, i, w, w),
                          block(-i, -i, -w, i, i, -i), block(-i, -i, i, i, i, w)};
  if (hole > 0)
    for (const auto& b :
         {block(i, -w, -w, w, -h, w), block(i, h, -w, w, w, w), block(i, -h, -w, w, h, -h), block(i, -h, h, w, h, w)})
      walls.push_back(b);
  else
    walls.push_back(block(i, -w, -w, w, w, w));
  return boxes(walls);
}

Pose random_turn(Rng& rng) {
  const Eigen::Quaterniond q(rng.normal(), rng.normal(), rng.normal(), rng.normal());
  return {Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()), q.normalized()};
}

TEST(WaysOut, NeverLeadThroughAWall) {
  Rng rng(11);
  int ways = 0;
  for (int k = 0; k < 6; ++k) {
    std::vector<Aabb> list;
    for (int n = 0; n < 25; ++n) {
      const Eigen::Vector3d at(rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-2, 2));
      const Eigen::Vector3d half(rng.uniform(0.02, 0.8), rng.uniform(0.02, 0.8), rng.uniform(0.02, 0.8));
      list.push_back({at - half, at + half});
    }
    const Assembly assembly = assembly_of({boxes(list)}, random_turn(rng));
    const Mesh& mesh = *assembly.parts[0].mesh;
    const TriangleBvh solid(mesh);
    const WaysOut ways_out(assembly, all_of(assembly), 0, kCells);
    for (int n = 0; n < 200; ++n) {
      Eigen::Vector3d p;
      for (int a = 0; a < 3; ++a) p[a] = rng.uniform(mesh.box().lo[a], mesh.box().hi[a]);
      if (ways_out.depth(p) > 0) continue;
      ++ways;
      const std::vector<Eigen::Vector3d> way = ways_out.way(p);
      ASSERT_FALSE(way.empty());
      EXPECT_FALSE(solid.inside(way.front()));
      for (std::size_t i = 1; i < way.size(); ++i) {
        EXPECT_LT(ways_out.length(way[i]), ways_out.length(way[i - 1]));
        for (const double t : {0.25, 0.5, 0.75, 1.0})
          EXPECT_FALSE(solid.inside(way[i - 1] + t * (way[i] - way[i - 1])));
      }
      Aabb rim = mesh.box();
      rim.inflate(ways_out.cell());
      EXPECT_FALSE(rim.contains(way.back()));
    }
  }
  EXPECT_GT(ways, 300);
}

TEST(WaysOut, ThereIsNoneOutOfWhatIsClosed) {
  Rng rng(12);
  for (int k = 0; k < 4; ++k) {
    const Pose turned = random_turn(rng);
    const Assembly closed = assembly_of({hollow(0)}, turned), open = assembly_of({hollow(1)}, turned);
    const WaysOut none(closed, all_of(closed), 0, kCells), some(open, all_of(open), 0, kCells);
    const WaysOut too_large(open, all_of(open), 0.5 + 2 * some.cell(), kCells);
    for (int n = 0; n < 50; ++n) {
      const Eigen::Vector3d p =
          turned * (1.1 * Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)));
      EXPECT_GT(none.depth(p), 0U);
      EXPECT_EQ(some.depth(p), 0U);
      EXPECT_GT(too_large.depth(p), 0U) << "a ball that is larger than the hole";
    }
  }
}

TEST(WaysOut, ANarrowPlaceCanBeClosed) {
  const Assembly assembly = assembly_of({hollow(0.8)});
  WaysOut ways(assembly, all_of(assembly), 0, kCells);
  const Eigen::Vector3d p(0.3, -0.2, 0.1);
  ASSERT_EQ(ways.depth(p), 0U);
  EXPECT_FALSE(ways.close_narrowest(p, 0));
  EXPECT_EQ(ways.depth(p), 0U);
  ASSERT_TRUE(ways.close_narrowest(p, 100));
  EXPECT_GT(ways.depth(p), 0U) << "there was no other";
}

TEST(WaysOut, OutsideItIsStraight) {
  const Assembly assembly = assembly_of({hollow(0)});
  const WaysOut ways(assembly, all_of(assembly), 0, kCells);
  const Eigen::Vector3d p(0, 0, 5);
  EXPECT_LT(ways.length(p), 0);
  EXPECT_LT(ways.length(ways.ahead(p)), ways.length(p));
}

}  // namespace
}  // namespace dismantle::free_space
