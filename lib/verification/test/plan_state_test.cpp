// How far a point may travel between two poses of a plan, against the travel of each vertex.
#include "plan/plan_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

TEST(PlanState, NoVertexTravelsFurtherOnTheScrewThanAHundredthOfTheAssembly) {
  Rng rng(17);
  int far = 0;
  constexpr int kTrials = 2000;
  for (int i = 0; i < kTrials; ++i) {
    // Small turns of a bar; every fourth time large ones of a chip near the axis, whose arc is much longer than its
    // chord.
    const bool chip = i % 4 == 0;
    const double size = chip ? 0.05 : 1;
    const Mesh bar = shapes::moved(
        shapes::box({0, 0, 0},
                    size * Eigen::Vector3d(rng.uniform(0.01, 9), rng.uniform(0.01, 1), rng.uniform(0.01, 1))),
        shapes::random_pose(rng, 1));
    const Assembly assembly = shapes::assembly_of({bar, shapes::box({-5, -5, -5}, {5, 5, 5})});
    Aabb all = bar.box();
    all.extend(assembly.parts[1].mesh->box());
    const double most = 0.01 * all.size().maxCoeff();
    Pose a = shapes::random_pose(rng, 3);
    const double angle = chip ? rng.uniform(0, M_PI) : rng.uniform(0, 0.05);
    const Eigen::Vector3d axis = shapes::random_vector(rng, -1, 1).normalized(),
                          through = a * bar.vertices[0] +
                                    rng.uniform(0, 0.2) * size * shapes::random_vector(rng, -1, 1).normalized();
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, axis));
    const Pose b{through + turn * (a.t - through) + rng.uniform(0, chip ? 0.05 : 0.15) * axis, turn * a.q};
    double travel = 0;
    for (const Eigen::Vector3d& v : bar.vertices) travel = std::max(travel, screw_travel(a, b, v, 0));
    if (std::abs(travel - most) < 1e-9) continue;
    std::vector<std::string> problems;
    PlanMove move;
    move.part = assembly.parts[0].name;
    move.poses = {assembly.normalization.pose_to_input(a), assembly.normalization.pose_to_input(b)};
    PlanState(assembly).read({move}, problems);
    EXPECT_EQ(problems.size(), travel > most ? 1u : 0u) << "trial " << i << ": " << travel << " of " << most;
    far += travel > most ? 1 : 0;
  }
  EXPECT_GT(far, kTrials / 5);
  EXPECT_LT(far, 4 * kTrials / 5);
}

}  // namespace
}  // namespace dismantle
