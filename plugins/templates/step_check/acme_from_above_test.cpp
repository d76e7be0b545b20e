// Tests of acme.from_above beyond the laws of its kind, which `dismantle plugins check` tests.
#include <gtest/gtest.h>

#include <cmath>

#include "dismantle/host/registry.h"
#include "dismantle/testing/fake_planning.h"

namespace {

using Eigen::Vector3d;

dismantle::StepVerdict verdict(const Vector3d& direction, const Vector3d& up, double angle) {
  dismantle::Registry registry;
  registry.load(PLUGIN_FILE);
  const dismantle::Assembly assembly = dismantle::fake::row(2);
  const std::vector<dismantle::PlacedPart> moving{{1, {}}}, present{{0, {}}};
  return registry.create<dismantle::StepCheck>("acme.from_above", {{"angle", angle}})
      ->judge({assembly, moving, present, direction, nullptr, up}, {});
}

TEST(AcmeFromAbove, CostsNothingFromAboveAndOneFromBelow) {
  dismantle::Rng rng(1);
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3d up = Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    const Vector3d side = up.cross(Vector3d(rng.normal(), rng.normal(), rng.normal())).normalized();
    EXPECT_NEAR(verdict(-up, up, 1).cost, 0, 1e-12);
    EXPECT_NEAR(verdict(side, up, 1).cost, 0.5, 1e-12);
    EXPECT_NEAR(verdict(up, up, 1).cost, 1, 1e-12);
  }
}

TEST(AcmeFromAbove, BeyondTheAngleAPartHasToBeHeld) {
  const Vector3d up = Vector3d::UnitZ();
  for (const double angle : {0.2, 0.9, 1.1, 2.0, 3.0}) {
    const auto v = verdict(Vector3d(std::sin(angle), 0, -std::cos(angle)), up, 1);
    EXPECT_EQ(v.allowed, angle < 1) << angle;
    EXPECT_EQ(v.notes.size(), angle < 1 ? 0u : 1u) << angle;
    EXPECT_FALSE(v.reason.empty());
  }
  EXPECT_TRUE(verdict(Vector3d::Zero(), up, 0).allowed) << "a rotation in place";
}

}  // namespace
