#include <gtest/gtest.h>

#include <cmath>

#include "dismantle/testing/shapes.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {
namespace {

/// A cube that slides along a plate in which it is `depth` deep.
TEST(VerifyBudget, PenetrationIsReportedAsAShareOfTheTolerance) {
  Rng rng(22);
  const Mesh cube = shapes::box({-.5, -.5, -.5}, {.5, .5, .5}), plate = shapes::box({-3, -3, -1.5}, {3, 3, -0.5});
  const Assembly assembly = shapes::assembly_of({cube, plate}, {});
  for (int trial = 0; trial < 40; ++trial) {
    const double most = rng.uniform(0.001, 0.1), depth = rng.uniform(0, 0.95) * most;
    const Path path = {{shapes::shift({-1, 0, -depth})}, {shapes::shift({1, rng.uniform(-1, 1), -depth})}};
    const MotionCheck c = Verifier(assembly, {most}).check_motion({0}, {{1, Pose{}}}, path);
    ASSERT_TRUE(c.valid) << depth << " of " << most;
    EXPECT_GE(c.max_penetration, depth * (1 - 1e-6));
    const double share = most / c.max_penetration;
    bool known = false;
    for (const double divisor : {1, 2, 5, 10, 20, 50, 100}) known = known || std::abs(share - divisor) < 1e-6;
    EXPECT_TRUE(known) << share;
  }
}

/// A large budget accepts every motion that a small one accepts. Motions refused for lack of budget are uncertain.
TEST(VerifyBudget, ASmallBudgetRefusesWithoutAProof) {
  const Mesh disc = shapes::tube(0, 2, -.2, .2, 64), housing = shapes::tube(2, 3, -.4, .4, 64);
  const Assembly assembly = shapes::assembly_of({disc, housing}, {});
  const Path path = {{Pose{}}, {Pose{{0, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()))}}};
  bool accepted = false, refused = false;
  for (const std::uint64_t tests : {1u, 100u, 10'000u, 1'000'000u}) {
    VerifyOptions options;
    options.max_penetration = 0.01;  // the corners of the disc cut 0.0024 into the faces of the housing
    options.budget.tests = tests;
    options.budget.tests_per_segment = 0;
    const MotionCheck c = Verifier(assembly, options).check_motion({0}, {{1, Pose{}}}, path);
    EXPECT_TRUE(c.valid || !accepted) << tests;
    EXPECT_TRUE(c.valid || (c.violation && c.violation->uncertain)) << tests;
    accepted = accepted || c.valid;
    refused = refused || !c.valid;
  }
  EXPECT_TRUE(accepted && refused);
}

}  // namespace
}  // namespace dismantle
