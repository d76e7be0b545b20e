#include "dismantle/geometry/mass_properties.h"

#include <gtest/gtest.h>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/testing/mesh_damage.h"

namespace dismantle {
namespace {

using namespace shapes;

TEST(MassProperties, OfABoxMatchTheClosedForm) {
  const MassProperties b = mass_properties(box({100, 0, 0}, {102, 3, 4}));
  EXPECT_NEAR(b.volume, 24, 1e-9);
  EXPECT_NEAR((b.center - Vec3(101, 1.5, 2)).norm(), 0, 1e-9);
  EXPECT_NEAR(b.inertia(0, 0), 24.0 / 12 * (9 + 16), 1e-8);
  EXPECT_NEAR(b.inertia(1, 1), 24.0 / 12 * (4 + 16), 1e-8);
  EXPECT_NEAR(b.inertia(2, 2), 24.0 / 12 * (4 + 9), 1e-8);
  EXPECT_NEAR(b.inertia(0, 1), 0, 1e-8);
}

TEST(MassProperties, MoveAndTurnWithTheSolid) {
  Rng rng(3);
  for (int round = 0; round < 40; ++round) {
    const Mesh mesh = random_solid(rng);
    const Pose pose = random_pose(rng, 3);
    Mesh moved = mesh;
    for (auto& v : moved.vertices) v = pose * v;
    const MassProperties a = mass_properties(mesh), b = mass_properties(moved);
    const Eigen::Matrix3d turn = pose.q.toRotationMatrix();
    EXPECT_NEAR(a.volume, signed_volume(mesh), 1e-10);
    EXPECT_NEAR(b.volume, a.volume, 1e-9);
    EXPECT_NEAR((b.center - pose * a.center).norm(), 0, 1e-9);
    EXPECT_NEAR((b.inertia - turn * a.inertia * turn.transpose()).norm(), 0, 1e-9);
  }
}

}  // namespace
}  // namespace dismantle
