#include "path_length.h"

#include <gtest/gtest.h>

#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::checks {
namespace {

using Eigen::Vector3d;

// Law: the cost is the length of the way over the size of the assembly, in whatever unit the input is.
TEST(PathLength, IsTheWayRelativeToTheAssembly) {
  Rng rng(3);
  for (int k = 0; k < 200; ++k) {
    const double unit = rng.uniform(0.1, 50);
    Assembly assembly = shapes::assembly_of({shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({2, 0, 0}, {10, 1, 1})});
    assembly.normalization.scale = 1 / unit;
    assembly.input_box = {Vector3d::Zero(), Vector3d(10, 1, 1) * unit};
    Trace path(1, {Pose{}});
    double length = 0;
    for (int leg = 0; leg < 4; ++leg) {
      Pose pose = path.back().front();
      const Vector3d step(rng.normal(), rng.normal(), rng.normal());
      pose.t += step;
      length += step.norm();
      path.push_back({pose});
    }
    const std::vector<PlacedPart> moving{{0, Pose{}}};
    const StepVerdict v =
        PathLength().judge({assembly, moving, {}, Vector3d::UnitX(), &path}, RunContext{});
    EXPECT_NEAR(v.cost, length / 10, 1e-9);
    EXPECT_TRUE(v.allowed);
    EXPECT_EQ(PathLength().judge({assembly, moving, {}, Vector3d::UnitX()}, RunContext{}).cost, 0);
  }
}

}  // namespace
}  // namespace dismantle::checks
