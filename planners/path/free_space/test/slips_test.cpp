// What slips along itself is found, however it lies in space, and nothing else.
#include "dismantle/free_space/slips.h"

#include <gtest/gtest.h>

#include "dismantle/run_context.h"
#include "helix.h"
#include "solids.h"

namespace dismantle::free_space {
namespace {

using Eigen::Vector3d;
using path::test::helix;
using path::test::Helix;
using path::test::moved;
using path::test::random_pose;

/// Of a motion about `center`: where it takes `p` in a short time.
Vector3d speed(const Twist& twist, const Vector3d& center, const Vector3d& p) {
  return twist.way + twist.turn.cross(p - center);
}

TEST(Slips, OfAHelixAreItsScrew) {
  Rng rng(2);
  for (int k = 0; k < 10; ++k) {
    const Pose pose = random_pose(rng, 3);
    const Helix h{.radius = rng.uniform(0.3, 1), .pitch = rng.uniform(0.2, 1), .wire = 0.02, .turns = 3};
    const Mesh mesh = moved(helix(h), pose);
    const Vector3d center = mesh.box().center();
    const std::vector<Twist> found = slips(mesh, center);
    ASSERT_EQ(found.size(), 1U);
    // About its axis and along it, by its pitch; points move by about 1.
    const Vector3d axis = pose.q * Vector3d::UnitX(), turn = found[0].turn;
    EXPECT_GT(std::abs(turn.normalized().dot(axis)), 0.999);
    const Vector3d on_axis = pose * Vector3d(0.5 * h.pitch * h.turns, 0, 0);
    EXPECT_NEAR(speed(found[0], center, on_axis).dot(axis) / turn.dot(axis), h.pitch / (2 * M_PI), 0.05 * h.pitch);
    EXPECT_NEAR(turn.norm() * h.radius, 1, 0.2);
  }
}

TEST(Slips, OfARodAreAlongItAndAboutIt) {
  Rng rng(3);
  const Mesh rod = moved(helix({.radius = 0, .pitch = 4, .wire = 0.02, .turns = 1, .around = 24}), random_pose(rng, 3));
  const std::vector<Twist> found = slips(rod, rod.box().center());
  EXPECT_EQ(found.size(), 2U);
}

TEST(Slips, OfABoxAreNone) {
  Rng rng(4);
  for (int k = 0; k < 20; ++k) {
    const Vector3d half(rng.uniform(0.2, 1), rng.uniform(0.2, 1), rng.uniform(0.2, 1));
    const Mesh box =
        moved(path::test::boxes({path::test::block(-half.x(), -half.y(), -half.z(), half.x(), half.y(), half.z())}),
              random_pose(rng, 3));
    EXPECT_TRUE(slips(box, box.box().center()).empty()) << half.transpose();
  }
}

TEST(Slips, OfNothingAreNone) { EXPECT_TRUE(slips(Mesh{}, Vector3d::Zero()).empty()); }

}  // namespace
}  // namespace dismantle::free_space
