// Medial balls fit into their body and are spread over it.
#include "dismantle/free_space/medial_balls.h"

#include <gtest/gtest.h>

#include "dismantle/geometry/triangle_bvh.h"
#include "solids.h"

namespace dismantle::free_space {
namespace {

TEST(MedialBalls, FitIntoTheBody) {
  const Mesh ring = path::test::open_ring(0.5);
  const TriangleBvh bvh(ring);
  const std::vector<MedialBall> balls = medial_balls(ring, 16);
  ASSERT_EQ(balls.size(), 16U);
  Aabb spread;
  for (const auto& b : balls) {
    EXPECT_NEAR(bvh.signed_distance(b.center), -b.radius, 1e-6);
    EXPECT_LE(b.radius, 0.25 + 1e-6);
    spread.extend(b.center);
  }
  EXPECT_GT(spread.size().x(), 2.2);
  EXPECT_GT(spread.size().y(), 2.2);
}

}  // namespace
}  // namespace dismantle::free_space
