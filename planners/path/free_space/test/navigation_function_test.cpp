// Along a route the remaining length falls. Routes never lead through a wall, and do not exist in closed space.
#include "dismantle/free_space/navigation_function.h"

#include <gtest/gtest.h>

#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/run_context.h"
#include "solids.h"

namespace dismantle::free_space {
namespace {

using path::test::assembly_of;
using path::test::block;
using path::test::boxes;

const GridParameters kGrid{.cells = 60'000};

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

TEST(NavigationFunction, NoRouteLeadsThroughAWall) {
  Rng rng(11);
  int routes = 0;
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
    const NavigationFunction navigation(assembly, all_of(assembly), 0, kGrid);
    for (int n = 0; n < 200; ++n) {
      Eigen::Vector3d p;
      for (int a = 0; a < 3; ++a) p[a] = rng.uniform(mesh.box().lo[a], mesh.box().hi[a]);
      if (navigation.cells_to_route(p) > 0) continue;
      ++routes;
      const std::vector<Eigen::Vector3d> route = navigation.route(p);
      ASSERT_FALSE(route.empty());
      EXPECT_FALSE(solid.inside(route.front()));
      for (std::size_t i = 1; i < route.size(); ++i) {
        EXPECT_LT(navigation.remaining(route[i]), navigation.remaining(route[i - 1]));
        for (const double t : {0.25, 0.5, 0.75, 1.0})
          EXPECT_FALSE(solid.inside(route[i - 1] + t * (route[i] - route[i - 1])));
      }
      Aabb boundary = mesh.box();
      boundary.inflate(navigation.cell());
      EXPECT_FALSE(boundary.contains(route.back()));
    }
  }
  EXPECT_GT(routes, 300);
}

TEST(NavigationFunction, AClosedBoxHasNoRoute) {
  Rng rng(12);
  for (int k = 0; k < 4; ++k) {
    const Pose turned = random_turn(rng);
    const Assembly closed = assembly_of({hollow(0)}, turned), open = assembly_of({hollow(1)}, turned);
    const NavigationFunction none(closed, all_of(closed), 0, kGrid), some(open, all_of(open), 0, kGrid);
    const NavigationFunction too_large(open, all_of(open), 0.5 + 2 * some.cell(), kGrid);
    for (int n = 0; n < 50; ++n) {
      const Eigen::Vector3d p =
          turned * (1.1 * Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)));
      EXPECT_GT(none.cells_to_route(p), 0U);
      EXPECT_EQ(some.cells_to_route(p), 0U);
      EXPECT_GT(too_large.cells_to_route(p), 0U) << "a ball that is larger than the hole";
    }
  }
}

TEST(NavigationFunction, ANarrowPlaceCanBeBlocked) {
  const Assembly assembly = assembly_of({hollow(0.8)});
  NavigationFunction navigation(assembly, all_of(assembly), 0, kGrid);
  const Eigen::Vector3d p(0.3, -0.2, 0.1);
  ASSERT_EQ(navigation.cells_to_route(p), 0U);
  EXPECT_FALSE(navigation.close_narrowest(p, 0));
  EXPECT_EQ(navigation.cells_to_route(p), 0U);
  ASSERT_TRUE(navigation.close_narrowest(p, 100));
  EXPECT_GT(navigation.cells_to_route(p), 0U) << "there was no other route";
}

TEST(NavigationFunction, RoutesFromOutsideAreStraight) {
  const Assembly assembly = assembly_of({hollow(0)});
  const NavigationFunction navigation(assembly, all_of(assembly), 0, kGrid);
  const Eigen::Vector3d p(0, 0, 5);
  EXPECT_LT(navigation.remaining(p), 0);
  EXPECT_LT(navigation.remaining(navigation.lookahead(p)), navigation.remaining(p));
}

}  // namespace
}  // namespace dismantle::free_space
