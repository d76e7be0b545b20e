#include "dismantle/geometry/congruent_parts.h"

#include <gtest/gtest.h>

#include "dismantle/testing/shapes.h"

namespace dismantle::geometry {
namespace {

using shapes::Vec3;

Mesh brick() { return shapes::box({0, 0, 0}, {4, 2, 1}); }

const Pose kTurned{{7, -3, 2}, Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()))};

TEST(AlikePairs, ArePairsOfCongruentPartsThatLieAlike) {
  const Pose above = shapes::shift({2, 0, 1}), beside = shapes::shift({4, 0, 0});
  std::vector<Mesh> meshes;
  for (const Pose& base : {Pose{}, kTurned, shapes::shift({50, 0, 0})})
    for (const Pose& pose : {Pose{}, above, beside}) meshes.push_back(shapes::moved(brick(), base * pose));
  const Assembly made = shapes::assembly_of(meshes);
  const auto alike = find_alike(made.parts, {{0, 1}, {0, 2}, {3, 4}, {3, 5}, {6, 7}, {7, 6}, {6, 8}, {3, 7}}, 1e-9);
  const std::vector<std::size_t> expected{0, 1, 0, 1, 0, 5, 1, 7};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(alike[i].original, expected[i]) << i;
  const Vec3 x(1, 2, 3);
  EXPECT_NEAR((alike[2].pose * x - kTurned * x).norm(), 0, 1e-9);
  EXPECT_NEAR((alike[4].pose * x - (x + Vec3(50, 0, 0))).norm(), 0, 1e-9);
}

TEST(AlikePairs, DifferByMoreThanTheTolerance) {
  const Assembly made = shapes::assembly_of({brick(), shapes::moved(brick(), shapes::shift({2, 0, 1})),
                                             shapes::moved(brick(), shapes::shift({2, 0, 1.001}))});
  EXPECT_EQ(find_alike(made.parts, {{0, 1}, {0, 2}}, 1e-2)[1].original, 0u);
  EXPECT_EQ(find_alike(made.parts, {{0, 1}, {0, 2}}, 1e-4)[1].original, 1u);
}

}  // namespace
}  // namespace dismantle::geometry
