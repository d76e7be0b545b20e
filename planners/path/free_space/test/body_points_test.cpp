// Points of a body lie in its middle, and the twist that they ask for is the one that they were moved by.
#include "dismantle/free_space/body_points.h"

#include <gtest/gtest.h>

#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/run_context.h"
#include "solids.h"

namespace dismantle::free_space {
namespace {

using Eigen::Vector3d;

Vector3d in_cube(Rng& rng) { return {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)}; }

TEST(BodyPoints, AreCentresOfBallsThatFit) {
  const Mesh ring = path::test::open_ring(0.5);
  const TriangleBvh bvh(ring);
  const std::vector<BodyPoint> points = body_points(ring, 16);
  ASSERT_EQ(points.size(), 16U);
  Aabb spread;
  for (const auto& p : points) {
    EXPECT_NEAR(bvh.signed_distance(p.center), -p.radius, 1e-6);
    EXPECT_LE(p.radius, 0.25 + 1e-6);
    spread.extend(p.center);
  }
  EXPECT_GT(spread.size().x(), 2.2);
  EXPECT_GT(spread.size().y(), 2.2);
}

TEST(ClosestTwist, IsTheOneThatMovedThePoints) {
  Rng rng(4);
  for (int k = 0; k < 50; ++k) {
    const Vector3d way = in_cube(rng), turn = in_cube(rng), center = in_cube(rng);
    std::vector<Vector3d> points, wishes;
    std::vector<double> weights;
    for (int n = 0; n < 12; ++n) {
      points.push_back(in_cube(rng));
      wishes.push_back(way + turn.cross(points.back() - center));
      weights.push_back(rng.uniform(0.1, 1));
    }
    const Twist twist = closest_twist(points, wishes, weights, center);
    EXPECT_LT((twist.turn - turn).norm(), 0.02 * turn.norm());
    EXPECT_LT((twist.way - way).norm(), 0.02 * (way.norm() + turn.norm()));
  }
}

TEST(ClosestTwist, DoesNotTurnARodAboutItself) {
  Rng rng(5);
  std::vector<Vector3d> points, wishes;
  for (int n = 0; n < 10; ++n) {
    points.emplace_back(n, 0, 0);
    wishes.push_back(in_cube(rng));
  }
  const Twist twist = closest_twist(points, wishes, std::vector<double>(points.size(), 1), Vector3d::Zero());
  EXPECT_NEAR(twist.turn.x(), 0, 1e-9);
  EXPECT_TRUE(twist.way.allFinite() && twist.turn.allFinite());
}

}  // namespace
}  // namespace dismantle::free_space
