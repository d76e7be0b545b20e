#include "reorientations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dismantle/run_context.h"

namespace dismantle::checks {
namespace {

using Eigen::Vector3d;

StepVerdict verdict(const Vector3d& before, const Vector3d& now, const ReorientationsParameters& params = {}) {
  const Assembly assembly;
  const StepQuestion previous{assembly, {}, {}, Vector3d::UnitX(), nullptr, before};
  return Reorientations(params).judge({assembly, {}, {}, Vector3d::UnitY(), nullptr, now, &previous}, RunContext{});
}

TEST(Reorientations, TheFirstStepCostsNothing) {
  const Assembly assembly;
  EXPECT_EQ(Reorientations().judge({assembly, {}, {}, Vector3d::UnitX()}, RunContext{}).cost, 0);
}

// Law: the cost is 1, with one note, exactly when the upward directions are farther apart than `angle`.
TEST(Reorientations, CostsOneWhenTheAssemblyIsTurned) {
  Rng rng(7);
  unsigned same = 0, turned = 0;
  for (int k = 0; k < 1000; ++k) {
    const Vector3d from = Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    const Vector3d axis = from.cross(Vector3d(rng.normal(), rng.normal(), rng.normal())).normalized();
    const double angle = std::numbers::pi * rng.uniform(), limit = std::numbers::pi * rng.uniform();
    if (std::abs(angle - limit) < 1e-9) continue;
    const StepVerdict v = verdict(from, Eigen::AngleAxisd(angle, axis) * from, {.angle = limit});
    EXPECT_EQ(v.cost, angle > limit ? 1 : 0) << angle << " " << limit;
    EXPECT_EQ(v.notes.size(), angle > limit ? 1u : 0u);
    EXPECT_EQ(v.reason.empty(), v.cost == 0);
    EXPECT_TRUE(v.allowed);
    ++(v.cost == 0 ? same : turned);
  }
  EXPECT_GT(same, 250u);
  EXPECT_GT(turned, 250u);
}

TEST(Reorientations, TheNoteSaysHowFar) {
  EXPECT_EQ(verdict(Vector3d::UnitZ(), -Vector3d::UnitZ()).notes.at(0).text, "Turn the assembly over.");
  EXPECT_EQ(verdict(Vector3d::UnitZ(), Vector3d::UnitX()).notes.at(0).text, "Turn the assembly by 90 degrees.");
}

}  // namespace
}  // namespace dismantle::checks
