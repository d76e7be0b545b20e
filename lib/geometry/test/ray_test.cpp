// The first hit of a ray, against all triangles one by one.
#include "dismantle/geometry/ray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "dismantle/testing/shapes.h"

namespace dismantle::geometry {
namespace {

using shapes::Vec3;

/// Distance to the triangle along the ray; infinity if the ray misses it.
double hit(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& from, const Vec3& along) {
  const Vec3 normal = (b - a).cross(c - a);
  const double d = normal.dot(a - from) / normal.dot(along);
  const Vec3 x = from + d * along;
  const bool inside = (b - a).cross(x - a).dot(normal) >= 0 && (c - b).cross(x - b).dot(normal) >= 0 &&
                      (a - c).cross(x - c).dot(normal) >= 0;
  return inside && d >= 0 ? d : std::numeric_limits<double>::infinity();
}

TEST(Ray, FirstHitEqualsBruteForce) {
  Rng rng(5);
  int hits = 0;
  for (int part = 0; part < 6; ++part) {
    const Mesh mesh =
        shapes::moved(part % 2 == 0 ? shapes::tube(0.6, 1.3, -1, 2, 40, 6) : shapes::sphere({0, 0, 0}, 1, 3),
                      shapes::random_pose(rng, 2));
    const TriangleBvh bvh(mesh);
    for (int i = 0; i < 300; ++i) {
      const Vec3 from = shapes::random_vector(rng, -4, 4);
      Vec3 along = shapes::random_vector(rng, -1, 1);
      if (i % 3 == 0) along = Vec3::Unit(i % 9 / 3);  // along an axis
      along.normalize();
      const double reach = rng.uniform(0.5, 8);
      const auto counts = [&](std::uint32_t t) { return i % 2 == 0 || t % 2 == 0; };
      double best = std::numeric_limits<double>::infinity();
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        if (counts(t)) best = std::min(best, hit(mesh.vertex(t, 0), mesh.vertex(t, 1), mesh.vertex(t, 2), from, along));
      if (best > reach) best = std::numeric_limits<double>::infinity();
      const double found = first_hit(bvh, from, along, reach, counts);
      if (std::isfinite(best)) {
        ++hits;
        EXPECT_NEAR(found, best, 1e-9);
      } else {
        EXPECT_FALSE(std::isfinite(found)) << found;
      }
    }
  }
  EXPECT_GT(hits, 50);
}

}  // namespace
}  // namespace dismantle::geometry
