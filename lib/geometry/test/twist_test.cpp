// A body follows the flow of a twist, and fitting its velocities gives the same twist.
#include "dismantle/geometry/twist.h"

#include <gtest/gtest.h>

#include "dismantle/run_context.h"

namespace dismantle::geometry {
namespace {

using Eigen::Vector3d;

Vector3d normal_vector(Rng& rng) { return {rng.normal(), rng.normal(), rng.normal()}; }
Vector3d in_cube(Rng& rng) { return {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)}; }

TEST(MovedAlong, IsTheFlowOfTheTwist) {
  Rng rng(5);
  for (int i = 0; i < 200; ++i) {
    const Pose start = Pose{normal_vector(rng), rotation_from_vector(2 * normal_vector(rng))};
    const Vector3d local = normal_vector(rng);
    Twist t{normal_vector(rng), normal_vector(rng)};
    if (i % 4 == 0) t.angular.setZero();
    const Vector3d center = start * local;
    // Two half motions equal the whole motion: the screw is constant in the axes of the part.
    const double duration = rng.uniform(-1, 1);
    const Pose half = moved_along(start, t, center, duration / 2);
    const Eigen::Quaterniond turn = half.q * start.q.conjugate();
    const Pose whole = moved_along(half, {turn * t.linear, turn * t.angular}, half * local, duration / 2);
    const Pose direct = moved_along(start, t, center, duration);
    EXPECT_LT((whole.t - direct.t).norm(), 1e-9);
    EXPECT_LT(angle_between(whole.q, direct.q), 1e-7);
    // Its velocity at the start.
    const double h = 1e-6;
    const Pose soon = moved_along(start, t, center, h);
    EXPECT_LT(((soon * local - center) / h - t.linear).norm(), 1e-4);
  }
}

TEST(FittedTwist, IsTheOneThatMovesThePoints) {
  Rng rng(4);
  for (int k = 0; k < 50; ++k) {
    const Vector3d linear = in_cube(rng), angular = in_cube(rng), center = in_cube(rng);
    std::vector<Vector3d> points, velocities;
    std::vector<double> weights;
    for (int n = 0; n < 12; ++n) {
      points.push_back(in_cube(rng));
      velocities.push_back(linear + angular.cross(points.back() - center));
      weights.push_back(rng.uniform(0.1, 1));
    }
    const Twist twist = fitted_twist(points, velocities, weights, center);
    EXPECT_LT((twist.angular - angular).norm(), 0.02 * angular.norm());
    EXPECT_LT((twist.linear - linear).norm(), 0.02 * (linear.norm() + angular.norm()));
  }
}

TEST(FittedTwist, DoesNotTurnARodAboutItself) {
  Rng rng(5);
  std::vector<Vector3d> points, velocities;
  for (int n = 0; n < 10; ++n) {
    points.emplace_back(n, 0, 0);
    velocities.push_back(in_cube(rng));
  }
  const Twist twist = fitted_twist(points, velocities, std::vector<double>(points.size(), 1), Vector3d::Zero());
  EXPECT_NEAR(twist.angular.x(), 0, 1e-9);
  EXPECT_TRUE(twist.linear.allFinite() && twist.angular.allFinite());
}

}  // namespace
}  // namespace dismantle::geometry
