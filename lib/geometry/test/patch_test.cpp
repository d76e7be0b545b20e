// Depths and ways out of points on and near a surface.
#include "dismantle/geometry/patch.h"

#include <gtest/gtest.h>

#include "dismantle/geometry/solid.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/testing/voxels.h"

namespace dismantle::geometry {
namespace {

using shapes::Vec3;

/// Corners and edges of cubes that touch along edges: no depth, and a face's normal as the way out.
TEST(Escape, OfPointsOnTheSurfaceIsAlongAFace) {
  const Solid solid(voxels::surface({{0, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 2, 1}}));
  for (std::uint32_t t = 0; t < solid.mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = solid.mesh.vertex(t, k), b = solid.mesh.vertex(t, (k + 1) % 3);
      for (const double share : {0.0, 0.3, 0.5}) {
        const Escape out = escape_at(a + share * (b - a), solid);
        EXPECT_NEAR(out.depth, 0, 1e-12);
        EXPECT_NEAR(out.out.cwiseAbs().maxCoeff(), 1, 1e-12);
      }
    }
}

TEST(Escape, OfPointsAsideIsThatOfABox) {
  const Solid solid(shapes::box(Vec3::Zero(), Vec3(4, 4, 4)));
  const Escape inside = escape_at({2, 2, 3.5}, solid), outside = escape_at({2, 2, 4.5}, solid);
  EXPECT_NEAR(inside.depth, 0.5, 1e-12);
  EXPECT_NEAR(outside.depth, -0.5, 1e-12);
  EXPECT_NEAR((inside.out - Vec3::UnitZ()).norm(), 0, 1e-12);
  EXPECT_NEAR((outside.out - Vec3::UnitZ()).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace dismantle::geometry
