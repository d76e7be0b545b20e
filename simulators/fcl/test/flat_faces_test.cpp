// Laws: merging flat faces changes the number of triangles and nothing else.
#include "flat_faces.h"

#include <gtest/gtest.h>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::mesh_collision {
namespace {

constexpr double kTolerance = 1e-7;

void expect_same_surface(const Mesh& before, const Mesh& after, double scale) {
  EXPECT_TRUE(edge_use(after).closed());
  std::size_t shells_before = 0, shells_after = 0;
  shells_of(before, shells_before);
  shells_of(after, shells_after);
  EXPECT_EQ(shells_before, shells_after);
  EXPECT_NEAR(signed_volume(after), signed_volume(before), 1e-6 * std::abs(signed_volume(before)));
  EXPECT_NEAR(surface_area(after), surface_area(before), 1e-6 * surface_area(before));
  const TriangleBvh bvh(after), original(before);
  for (const auto& v : before.vertices) EXPECT_LE(bvh.closest(v).distance, 2 * kTolerance * scale);
  for (std::size_t t = 0; t < after.triangles.size(); ++t)
    EXPECT_LE(original.closest((after.vertex(t, 0) + after.vertex(t, 1) + after.vertex(t, 2)) / 3).distance,
              2 * kTolerance * scale);
}

TEST(FlatFaces, RefinedBoxIsABoxAgain) {
  Rng rng(1);
  for (int i = 0; i < 20; ++i) {
    const Mesh fine =
        shapes::moved(shapes::refine(shapes::box({-1, -2, -3}, {1, 2, 3}), 3), shapes::random_pose(rng, 5));
    const Mesh coarse = merge_flat_faces(fine, kTolerance);
    EXPECT_EQ(coarse.triangles.size(), 12u);
    expect_same_surface(fine, coarse, 1);
  }
}

TEST(FlatFaces, CurvedSurfacesStay) {
  const Mesh ball = shapes::sphere({0, 0, 0}, 1, 3);
  EXPECT_EQ(merge_flat_faces(ball, kTolerance).triangles.size(), ball.triangles.size());
}

/// All samples, finely subdivided: the result has no more triangles than the sample and is the same surface.
TEST(FlatFaces, SamplesKeepTheirShape) {
  for (const auto& sample : samples::list())
    for (const RawPart& part : samples::make(sample.name)) {
      if (part.mesh.triangles.size() > 2000) continue;
      const Mesh fine = shapes::refine(part.mesh, 1);
      const Mesh coarse = merge_flat_faces(fine, kTolerance * 10);
      EXPECT_LE(coarse.triangles.size(), part.mesh.triangles.size() * 11 / 10) << sample.name << " " << part.name;
      expect_same_surface(fine, coarse, 10);
    }
}

}  // namespace
}  // namespace dismantle::mesh_collision
