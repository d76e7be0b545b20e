#include "dismantle/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

using shapes::random_pose;
using shapes::random_vector;
using shapes::Vec3;

double gap(const Pose& a, const Pose& b) {
  return (a.t - b.t).norm() + std::min((a.q.coeffs() - b.q.coeffs()).norm(), (a.q.coeffs() + b.q.coeffs()).norm());
}

TEST(Pose, EndsOfAScrewAreExact) {
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    const Pose a = random_pose(rng, 10), b = random_pose(rng, 10);
    EXPECT_EQ(gap(screw_interpolate(a, b, 0), a), 0);
    EXPECT_EQ(gap(screw_interpolate(a, b, 1), b), 0);
    EXPECT_LT(gap(screw_interpolate(a, b, 1 - 1e-13), b), 1e-10);
    EXPECT_LT(gap(screw_interpolate(a, b, 1e-13), a), 1e-10);
  }
}

TEST(Pose, PureTranslationIsALine) {
  Rng rng(4);
  for (int i = 0; i < 100; ++i) {
    Pose a = random_pose(rng, 5), b = a;
    b.t += random_vector(rng, -3, 3);
    const double u = rng.uniform();
    const Pose m = screw_interpolate(a, b, u);
    EXPECT_LT((m.t - (a.t + u * (b.t - a.t))).norm(), 1e-14);
    EXPECT_LT(angle_between(m.q, a.q), 1e-14);
  }
}

TEST(Pose, TurnAboutAnAxisKeepsTheDistanceFromIt) {
  Rng rng(5);
  for (int i = 0; i < 200; ++i) {
    const Vec3 axis = random_vector(rng, -1, 1).normalized(), on_axis = random_vector(rng, -4, 4);
    const double angle = rng.uniform(1e-9, std::numbers::pi - 1e-6), advance = rng.uniform(-3, 3), u = rng.uniform();
    const auto screw = [&](double s) {
      const Eigen::Quaterniond q(Eigen::AngleAxisd(s * angle, axis));
      return Pose{on_axis - q * on_axis + s * advance * axis, q};
    };
    const Pose a = random_pose(rng, 5);
    EXPECT_LT(gap(screw_interpolate(a, screw(1) * a, u), screw(u) * a), 1e-11);
  }
}

TEST(Pose, TheShorterTurnIsTaken) {
  const Pose a;
  Pose b{Vec3::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(1.0, Vec3::UnitZ()))};
  b.q.coeffs() *= -1;  // the same rotation
  EXPECT_NEAR(angle_between(a.q, screw_interpolate(a, b, 0.5).q), 0.5, 1e-12);
  EXPECT_NEAR(angle_between(a.q, b.q), 1.0, 1e-12);
}

TEST(Pose, EqualStepsAreEqualMotions) {
  Rng rng(6);
  for (int i = 0; i < 100; ++i) {
    const Pose a = random_pose(rng, 5), b = random_pose(rng, 5);
    const Pose step = screw_interpolate(a, b, 0.25) * a.inverse();
    const Pose there = step * step * step * step * a;
    EXPECT_LT(gap(there, b), 1e-10);
  }
}

TEST(Pose, TravelBoundsTheWayOfEveryPointInTheBall) {
  Rng rng(7);
  for (int i = 0; i < 100; ++i) {
    const Pose a = random_pose(rng, 3), b = screw_interpolate(a, random_pose(rng, 3), rng.uniform());
    const Vec3 center = random_vector(rng, -2, 2);
    const double radius = rng.uniform(0, 2), bound = screw_travel(a, b, center, radius);
    const Vec3 p = center + radius * random_vector(rng, -1, 1).normalized();
    double distance = 0;
    Vec3 last = a * p;
    for (int k = 1; k <= 200; ++k) {
      const Vec3 next = screw_interpolate(a, b, k / 200.0) * p;
      distance += (next - last).norm();
      last = next;
    }
    EXPECT_LE(distance, bound + 1e-12);
    EXPECT_LE((b * center - a * center).norm(), screw_travel(a, b, center, 0) + 1e-12);
  }
}

TEST(Pose, RotationVectorAndBack) {
  Rng rng(8);
  for (int i = 0; i < 200; ++i) {
    const Vec3 w = random_vector(rng, -1, 1).normalized() * rng.uniform(0, std::numbers::pi - 1e-9);
    EXPECT_LT((rotation_vector(rotation_from_vector(w)) - w).norm(), 1e-9);
  }
  EXPECT_EQ(rotation_vector(Eigen::Quaterniond::Identity()), Vec3::Zero());
  EXPECT_LT((rotation_vector(rotation_from_vector(Vec3(1e-12, 0, 0))) - Vec3(1e-12, 0, 0)).norm(), 1e-24);
}

}  // namespace
}  // namespace dismantle
