#include "directions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dismantle/mesh.h"
#include "dismantle/run_context.h"

namespace dismantle::checks {
namespace {

using Eigen::Vector3d;

StepVerdict verdict(const Vector3d& before, const Vector3d& now, const DirectionsParameters& params = {}) {
  const Assembly assembly;
  const StepQuestion previous{assembly, {}, {}, before};
  return Directions(params).judge({assembly, {}, {}, now, nullptr, Vector3d::UnitZ(), &previous}, RunContext{});
}

TEST(Directions, TheFirstStepAndRotationsInPlaceCostNothing) {
  const Assembly assembly;
  EXPECT_EQ(Directions().judge({assembly, {}, {}, Vector3d::UnitX()}, RunContext{}).cost, 0);
  EXPECT_EQ(verdict(Vector3d::Zero(), Vector3d::UnitX()).cost, 0);
  EXPECT_EQ(verdict(Vector3d::UnitX(), Vector3d::Zero()).cost, 0);
}

// Law: the cost is 1 exactly when the directions are farther apart than `angle`, whatever the directions.
TEST(Directions, CostsOneWhenTheDirectionChanges) {
  Rng rng(5);
  unsigned same = 0, changed = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vector3d from = Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    const Vector3d axis = from.cross(Vector3d(rng.normal(), rng.normal(), rng.normal())).normalized();
    const double angle = 0.4 * rng.uniform(), limit = 0.4 * rng.uniform();
    if (std::abs(angle - limit) < 1e-9) continue;
    const StepVerdict v = verdict(from, Eigen::AngleAxisd(angle, axis) * from, {.angle = limit});
    EXPECT_EQ(v.cost, angle > limit ? 1 : 0) << angle << " " << limit;
    EXPECT_EQ(v.reason.empty(), v.cost == 0);
    EXPECT_TRUE(v.allowed);
    ++(v.cost == 0 ? same : changed);
  }
  EXPECT_GT(same, 500u);
  EXPECT_GT(changed, 500u);
}

TEST(Directions, OppositeDirectionsDiffer) {
  const StepVerdict v = verdict(Vector3d::UnitZ(), -Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 1);
  EXPECT_NE(v.reason.find("180 degrees"), std::string::npos) << v.reason;
}

// Law: however the assembly lies, from above <= from the side <= from below <= along no axis, in thirds; and the
// default says nothing about directions.
TEST(Directions, PrefersDirectionsFromAboveAndAlongAxes) {
  Rng rng(9);
  const Assembly assembly;
  const auto cost = [&](const Vector3d& direction, const Vector3d& up, double preference) {
    const StepVerdict v =
        Directions({.preference = preference}).judge({assembly, {}, {}, direction, nullptr, up}, RunContext{});
    EXPECT_EQ(v.reason.empty(), v.cost == 0);
    return v.cost;
  };
  for (int k = 0; k < 300; ++k) {
    const int axis = static_cast<int>(rng.below(3));
    const Vector3d up = (rng.below(2) == 0 ? 1 : -1) * Vector3d::Unit(axis), side = Vector3d::Unit((axis + 1) % 3);
    const double preference = rng.uniform(0.1, 5);
    EXPECT_EQ(cost(-up, up, preference), 0);
    EXPECT_DOUBLE_EQ(cost(side, up, preference), preference / 3);
    EXPECT_DOUBLE_EQ(cost(-side, up, preference), preference / 3);
    EXPECT_DOUBLE_EQ(cost(up, up, preference), preference * 2 / 3);
    const Vector3d skew = Vector3d(rng.uniform(0.3, 1), rng.uniform(0.3, 1), -rng.uniform(0.3, 1)).normalized();
    EXPECT_DOUBLE_EQ(cost(skew, up, preference), preference);
    EXPECT_EQ(cost(-skew, skew, preference), 0) << "straight from above, however it lies";
    EXPECT_EQ(cost(Vector3d::Zero(), up, preference), 0);
    EXPECT_EQ(cost(skew, up, 0), 0);
  }
}

TEST(Directions, AddsTheChangeToThePreference) {
  const StepVerdict v = verdict(Vector3d::UnitX(), Vector3d::UnitZ(), {.preference = 3});
  EXPECT_DOUBLE_EQ(v.cost, 1 + 2);
  EXPECT_NE(v.reason.find("90 degrees"), std::string::npos) << v.reason;
  EXPECT_NE(v.reason.find("from below"), std::string::npos) << v.reason;
}

}  // namespace
}  // namespace dismantle::checks
