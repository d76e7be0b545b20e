// Points of a body lie in its middle.
#include "dismantle/free_space/body_points.h"

#include <gtest/gtest.h>

#include "dismantle/geometry/triangle_bvh.h"
#include "solids.h"

namespace dismantle::free_space {
namespace {

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

}  // namespace
}  // namespace dismantle::free_space
