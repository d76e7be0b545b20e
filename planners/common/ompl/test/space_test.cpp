// Laws of the state space, nearest neighbours and checked motions.
#include <gtest/gtest.h>

#include "dismantle/ompl/nearest.h"
#include "dismantle/ompl/sampling_problem.h"
#include "dismantle/testing/path_checking.h"
#include "dismantle/testing/shapes.h"
#include "fake_world.h"

namespace dismantle::sampling {
namespace {

using Eigen::Vector3d;
using StateType = DisplacementSpace::StateType;

DisplacementSpace space_of(MotionSpace motion, Rng& rng) {
  Aabb bounds;
  bounds.extend(Vector3d(-5, -6, -7));
  bounds.extend(Vector3d(5, 6, 7));
  return {{shapes::random_vector(rng, -1, 1), rng.uniform(0.1, 3)}, motion, bounds};
}

/// No point of the mover travels further than the metric, measured point by point along the motion.
TEST(DisplacementSpace, MetricBoundsTravel) {
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    const DisplacementSpace space = space_of(i % 2 == 0 ? MotionSpace::rigid : MotionSpace::translation, rng);
    StateType a, b, c;
    space.draw(rng, a);
    space.draw(rng, b);
    space.draw(rng, c);
    EXPECT_NEAR(space.distance(a, b), space.distance(b, a), 1e-12);
    EXPECT_LE(space.distance(a, c), space.distance(a, b) + space.distance(b, c) + 1e-9);
    EXPECT_NEAR(space.distance(a, space.between(a, b, 0.3)), 0.3 * space.distance(a, b), 1e-6);
    const Vector3d point = space.mover().center + space.mover().radius * shapes::random_vector(rng, -1, 1).normalized();
    double travel = 0;
    for (int k = 1; k <= 200; ++k)
      travel += (space.displacement(space.between(a, b, k / 200.0)) * point -
                 space.displacement(space.between(a, b, (k - 1) / 200.0)) * point)
                    .norm();
    EXPECT_LE(travel, space.distance(a, b) + 1e-9);
    EXPECT_LE(space.distance(a, b), space.getMaximumExtent() + 1e-9);
  }
}

/// The screw motions of the resulting path follow the checked edge.
TEST(DisplacementSpace, PathFollowsTheEdge) {
  Rng rng(2);
  for (int i = 0; i < 50; ++i) {
    const DisplacementSpace space = space_of(MotionSpace::rigid, rng);
    StateType a, b;
    space.draw(rng, a);
    space.draw(rng, b);
    std::vector<Pose> poses{space.displacement(a)};
    append_edge(space, a, b, 1e-5, poses);
    const double n = static_cast<double>(poses.size() - 1);
    for (std::size_t k = 0; k + 1 < poses.size(); k += 1 + poses.size() / 20) {
      const Pose middle = screw_interpolate(poses[k], poses[k + 1], 0.5);
      const Pose edge = space.displacement(space.between(a, b, (static_cast<double>(k) + 0.5) / n));
      EXPECT_LT((middle * space.mover().center - edge * space.mover().center).norm(), 1.1e-5);
    }
    EXPECT_LT((poses.back() * space.mover().center - b.center).norm(), 1e-9);
  }
}

/// Rotations are uniform: each axis of the rotated frame is uniform on the sphere.
TEST(DisplacementSpace, DrawsUniformly) {
  Rng rng(3);
  const DisplacementSpace space = space_of(MotionSpace::rigid, rng);
  Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();
  Vector3d center = Vector3d::Zero();
  constexpr int kDraws = 20'000;
  for (int i = 0; i < kDraws; ++i) {
    StateType s;
    space.draw(rng, s);
    ASSERT_TRUE(space.satisfiesBounds(&s));
    turned += s.turn.toRotationMatrix() / kDraws;
    center += s.center / kDraws;
  }
  EXPECT_LT(turned.cwiseAbs().maxCoeff(), 0.02);
  EXPECT_LT(center.cwiseAbs().maxCoeff(), 0.15);
}

TEST(NearestNodes, AgreesWithLookingAtAll) {
  Rng rng(4);
  NearestNodes near;
  std::vector<Vector3d> points;
  std::vector<double> extra;  // the metric exceeds the distance of the points
  for (int i = 0; i < 600; ++i) {
    points.push_back((shapes::random_vector(rng, 0, 4)).array().round());  // many ties
    extra.push_back(rng.below(3));
    ASSERT_EQ(near.add(points.back()), static_cast<std::uint32_t>(i));
    if (rng.below(5) == 0) near.remove(static_cast<std::uint32_t>(rng.below(points.size())));
    const Vector3d q = shapes::random_vector(rng, 0, 4).array().round();
    const auto metric = [&](std::uint32_t n) { return (points[n] - q).norm() + extra[n]; };
    std::uint32_t best = geometry::kNoIndex;
    for (std::uint32_t n = 0; n < points.size(); ++n)
      if (!near.removed(n) && (best == geometry::kNoIndex || metric(n) < metric(best))) best = n;
    ASSERT_EQ(near.nearest(q, metric), best);
    std::vector<std::uint32_t> all;
    for (std::uint32_t n = 0; n < points.size(); ++n)
      if (!near.removed(n)) all.push_back(n);
    std::stable_sort(all.begin(), all.end(), [&](auto a, auto b) { return metric(a) < metric(b); });
    const std::size_t count = rng.below(9);
    all.resize(std::min(all.size(), count));
    ASSERT_EQ(near.nearest(q, metric, count), all);
  }
}

/// A wall as thick as a step is never missed, for any orientation of the wall and any length of the motion.
TEST(SamplingProblem, ThinWallIsNeverJumped) {
  constexpr double kStep = 0.01;
  Rng rng(5);
  const Assembly assembly =
      shapes::assembly_of({shapes::box({-1, -1, -1}, {1, 1, 1}), shapes::box({-5, -5, -5}, {5, 5, 5})});
  RunContext context;
  for (int i = 0; i < 60; ++i) {
    const Vector3d normal = shapes::random_vector(rng, -1, 1).normalized();
    const double at = rng.uniform(0.2, 2);
    fake::FakeSimulator simulator;
    simulator.depth = [&](const Pose& p) { return std::abs(normal.dot(p.t) - at) <= kStep / 2 ? 1.0 : 0.0; };
    const auto prepared = simulator.prepare(assembly, 0.01, context);
    const fake::RuleChecker checker = fake::accept_all();
    const PathQuery query{assembly, simulator, *prepared, {{{0, {}}}, {{1, {}}}}, {}, 0.01, checker};
    CheckBudget budget(query, context);
    SamplingProblem problem(query, i % 2 == 0 ? MotionSpace::translation : MotionSpace::rigid, 0.004, kStep, budget);
    for (int k = 0; k < 20; ++k) {
      StateType a, b;
      problem.space().draw(rng, a);
      problem.space().draw(rng, b);
      const double side_a = normal.dot(problem.space().displacement(a).t) - at;
      const double side_b = normal.dot(problem.space().displacement(b).t) - at;
      if (side_a * side_b > 0 || std::abs(side_a) < kStep) continue;
      EXPECT_LT(problem.free_share(a, b), 1);
      EXPECT_FALSE(problem.information()->checkMotion(&a, &b));  // through OMPL's interface
      // The kept part of an extension ends before the wall.
      const StateType last = problem.space().between(a, b, problem.free_share(a, b));
      EXPECT_GT((normal.dot(problem.space().displacement(last).t) - at) * side_a, 0);
    }
    // The step, as the fraction of the extent that OMPL needs.
    EXPECT_NEAR(problem.space().getLongestValidSegmentFraction() * problem.space().getMaximumExtent(), kStep, 1e-12);
  }
}

}  // namespace
}  // namespace dismantle::sampling
