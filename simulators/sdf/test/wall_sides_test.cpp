/// The sides of open surfaces, against the sum of solid angles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dismantle/sdf/solid.h"
#include "dismantle/sdf/surface_query.h"
#include "dismantle/testing/shapes.h"
#include "test_solids.h"

namespace dismantle::sdf {
namespace {

using Eigen::Vector3d;

/// Some of the triangles are gone, here and there or all of them on one side.
Mesh opened(Mesh mesh, Rng& rng) {
  const Vector3d side = shapes::random_vector(rng, -1, 1).normalized();
  const double from = rng.uniform(0.1, 1.2), share = rng.uniform(0, 0.3);
  const bool scattered = rng.below(2) == 0;
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    const Vector3d center = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
    return scattered ? rng.uniform(0, 1) < share : center.dot(side) > from;
  });
  if (mesh.triangles.size() > 4 && rng.below(2) == 0) mesh.triangles.push_back(mesh.triangles[3]);  // one twice
  return mesh;
}

/// Inside is where more than half of the view is surface seen from behind, whatever the openings.
TEST(WallSides, AreThoseOfTheGeneralisedWindingNumber) {
  Rng rng(52);
  std::size_t inside = 0, asked = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Mesh mesh = trial % 3 == 0   ? shapes::refine(shapes::box({-1, -1, -1}, {1, 1, 1}), 3)
                : trial % 3 == 1 ? test::torus(1.2, 0.5, 24, 12)
                                 : test::joined(shapes::refine(shapes::box({-1, -1, -0.4}, {0.3, 1, 1}), 2),
                                                shapes::refine(shapes::box({-0.2, -0.7, -1}, {1, 0.6, 0.5}), 2));
    mesh = opened(std::move(mesh), rng);
    const SurfaceQuery query(walls(mesh));
    for (int i = 0; i < 300; ++i) {
      Vector3d p = shapes::random_vector(rng, -1.5, 1.5);
      if (i % 3 == 0) p[static_cast<Eigen::Index>(rng.below(3))] = rng.below(2) == 0 ? 1 : -0.4;  // flush with faces
      const double w = mesh.box().contains(p) ? test::winding(mesh, p) : 0;
      if (std::abs(w - 0.5) < 1e-9 || test::distance(mesh, p) < 1e-9) continue;
      ++asked;
      inside += w > 0.5;
      ASSERT_EQ(query.sample(p).value<0, w> 0.5) << "trial " << trial << ", " << p.transpose() << ", " << w;
    }
  }
  EXPECT_GT(inside, asked / 10);
  EXPECT_LT(inside, asked / 2);
}

}  // namespace
}  // namespace dismantle::sdf
