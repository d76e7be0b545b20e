#include "dismantle/geometry/hulls_apart.h"

#include <gtest/gtest.h>

#include <limits>

#include "dismantle/geometry/hull.h"
#include "dismantle/geometry/swept_boxes.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::geometry {
namespace {

using shapes::random_pose;
using shapes::random_vector;
using shapes::Vec3;

/// Many small parts, more than one run holds, and their poses.
struct Heap {
  std::vector<Mesh> meshes;
  std::vector<Aabb> boxes;
  std::vector<std::vector<Vec3>> corners;
  std::vector<Pose> poses;

  Heap(Rng& rng, std::size_t count, double reach, bool turned) {
    for (std::size_t i = 0; i < count; ++i) {
      meshes.push_back(shapes::box(random_vector(rng, -0.5, -0.1), random_vector(rng, 0.1, 0.5)));
      boxes.push_back(meshes.back().box());
      corners.push_back(hull_corners(meshes.back().vertices));
      poses.push_back(turned ? random_pose(rng, reach) : Pose{random_vector(rng, -reach, reach), {1, 0, 0, 0}});
    }
  }
  std::vector<PlacedHull> placed() const {
    std::vector<PlacedHull> list;
    for (std::size_t i = 0; i < meshes.size(); ++i) list.push_back({&meshes[i], &boxes[i], &corners[i], poses[i]});
    return list;
  }
  std::vector<Vec3> points(const Vec3& shift) const {
    std::vector<Vec3> all;
    for (std::size_t i = 0; i < meshes.size(); ++i)
      for (const Vec3& c : corners[i]) all.push_back(poses[i] * c + shift);
    return all;
  }
};

TEST(HullsApart, OfManyPartsAreThoseOfAllTheirCorners) {
  Rng rng(31);
  int apart = 0, together = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const bool turned = trial % 2 == 0;
    const std::size_t most = trial % 10 < 8 ? 80 : 600;  // of these, boxes around boxes around boxes
    const Heap group(rng, 1 + rng.below(most / 2), 1, turned), rest(rng, 1 + rng.below(most), 2, turned);
    HullsApart hulls(group.placed(), rest.placed());
    for (int k = 0; k < 10; ++k) {
      const Vec3 shift = random_vector(rng, -4, 4);
      const bool expected = separate(group.points(shift), rest.points(Vec3::Zero())).has_value();
      EXPECT_EQ(hulls.after(shift), expected);
      (expected ? apart : together)++;
    }
  }
  EXPECT_GT(apart, 200);
  EXPECT_GT(together, 200);
}

TEST(TopOf, IsAsFarAsAnyPointOfTheBoxAndNotMuchFurther) {
  Rng rng(32);
  for (int trial = 0; trial < 300; ++trial) {
    const Mesh box = shapes::box(random_vector(rng, -3, 0), random_vector(rng, 0.1, 3));
    const Pose pose = random_pose(rng, 10);
    const Vec3 n = random_vector(rng, -1, 1).normalized();
    double top = -std::numeric_limits<double>::infinity();
    for (const Vec3& v : box.vertices) top = std::max(top, n.dot(pose * v));
    EXPECT_GE(top_of(box.box(), pose, n), top);
    EXPECT_LE(top_of(box.box(), pose, n), top + 1e-7);
  }
}

}  // namespace
}  // namespace dismantle::geometry
