// The quadratic program: conditions of optimality on random problems, and problems with known answers.
#include "nearest_point.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dismantle/run_context.h"

namespace dismantle::sdf_velocity {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd random_vector(Rng& rng, Index n) {
  VectorXd v(n);
  for (Index k = 0; k < n; ++k) v[k] = rng.normal();
  return v;
}

void constrain(NearestPoint& problem, const VectorXd& normal, double offset) {
  const Index i = problem.add();
  problem.normal(i) = normal.normalized();
  problem.offset(i) = offset;
}

/// Necessary and sufficient, since the problem is convex: y is feasible, only active constraints move it off the
/// target, and their multipliers are positive.
void expect_optimal(NearestPoint& problem, const VectorXd& target, const VectorXd& y) {
  for (Index i = 0; i < problem.count(); ++i) ASSERT_GE(problem.normal(i).dot(y), problem.offset(i) - 1e-9);
  VectorXd pull = y - target;
  for (std::size_t k = 0; k < problem.active().size(); ++k) {
    const Index i = problem.active()[k];
    ASSERT_GE(problem.forces()[k], 0);
    ASSERT_NEAR(problem.normal(i).dot(y), problem.offset(i), 1e-8);
    pull -= problem.forces()[k] * problem.normal(i);
  }
  ASSERT_LT(pull.norm(), 1e-8 * (1 + target.norm()));
}

TEST(NearestPoint, WithoutConstraintsItIsTheTarget) {
  NearestPoint problem;
  VectorXd y;
  problem.reset(6);
  const VectorXd target = VectorXd::LinSpaced(6, -1, 2);
  ASSERT_EQ(problem.solve(target, y), NearestPoint::Outcome::solved);
  EXPECT_EQ(y, target);
}

TEST(NearestPoint, IsOptimalOnRandomProblems) {
  Rng rng(31);
  NearestPoint problem;
  VectorXd y;
  for (int round = 0; round < 3000; ++round) {
    const Index n = round % 3 == 0 ? 3 : round % 3 == 1 ? 6 : 18;
    problem.reset(n);
    const auto count = static_cast<int>(rng.below(60));
    // Feasible by construction: `inside` satisfies all of them, some with equality.
    const VectorXd inside = 0.3 * random_vector(rng, n);
    for (int i = 0; i < count; ++i) {
      const VectorXd normal = random_vector(rng, n).normalized();
      constrain(problem, normal, normal.dot(inside) - (rng.below(2) == 0 ? 0.0 : rng.uniform(0, 0.5)));
    }
    const VectorXd target = random_vector(rng, n);
    ASSERT_EQ(problem.solve(target, y), NearestPoint::Outcome::solved) << round;
    expect_optimal(problem, target, y);
    EXPECT_LE(problem.active().size(), static_cast<std::size_t>(n));
    EXPECT_LE((y - target).norm(), (inside - target).norm() + 1e-9) << "no feasible point is nearer";
  }
}

TEST(NearestPoint, CopesWithConstraintsThatSayTheSame) {
  // Flush parts touch at hundreds of points: equal and nearly equal normals, all with zero gap.
  Rng rng(32);
  NearestPoint problem;
  VectorXd y;
  for (int round = 0; round < 300; ++round) {
    problem.reset(6);
    std::vector<VectorXd> kinds;
    for (int k = 0; k < 5; ++k) kinds.push_back(random_vector(rng, 6));
    const double blur = round % 3 == 0 ? 0.0 : round % 3 == 1 ? 1e-9 : 1e-4;
    for (int i = 0; i < 400; ++i) constrain(problem, kinds[rng.below(5)] + blur * random_vector(rng, 6), 0);
    const VectorXd target = random_vector(rng, 6);
    ASSERT_EQ(problem.solve(target, y), NearestPoint::Outcome::solved) << round;
    expect_optimal(problem, target, y);
  }
}

TEST(NearestPoint, OppositeConstraintsLeaveWhatIsBetweenThem) {
  NearestPoint problem;
  VectorXd y;
  problem.reset(3);
  for (int k = 0; k < 3; ++k) {
    constrain(problem, VectorXd::Unit(3, k), 0);
    if (k < 2) constrain(problem, -VectorXd::Unit(3, k), 0);
  }
  ASSERT_EQ(problem.solve(Eigen::Vector3d(3, -4, 5), y), NearestPoint::Outcome::solved);
  EXPECT_LT((y - Eigen::Vector3d(0, 0, 5)).norm(), 1e-12);
  ASSERT_EQ(problem.solve(Eigen::Vector3d(3, -4, -5), y), NearestPoint::Outcome::solved);
  EXPECT_LT(y.norm(), 1e-12);
}

TEST(NearestPoint, SaysWhenThereIsNone) {
  Rng rng(33);
  NearestPoint problem;
  VectorXd y;
  for (int round = 0; round < 200; ++round) {
    problem.reset(6);
    for (int i = 0; i < 20; ++i) constrain(problem, random_vector(rng, 6), -0.3);
    const VectorXd normal = random_vector(rng, 6).normalized();
    constrain(problem, normal, 0.1);
    constrain(problem, -normal, 0.01);
    EXPECT_EQ(problem.solve(random_vector(rng, 6), y), NearestPoint::Outcome::infeasible);
  }
}

TEST(NearestPoint, DoesNotDependOnWhatItSolvedBefore) {
  Rng rng(34);
  NearestPoint used;
  VectorXd y, z;
  for (int round = 0; round < 200; ++round) {
    const Index n = 3 + 3 * static_cast<Index>(rng.below(3));
    NearestPoint fresh;
    used.reset(n);
    fresh.reset(n);
    for (int i = 0; i < 100; ++i) {
      const VectorXd normal = random_vector(rng, n);
      constrain(used, normal, -0.1);
      constrain(fresh, normal, -0.1);
    }
    const VectorXd target = random_vector(rng, n);
    ASSERT_EQ(used.solve(target, y), fresh.solve(target, z));
    EXPECT_EQ(y, z);
  }
}

}  // namespace
}  // namespace dismantle::sdf_velocity
