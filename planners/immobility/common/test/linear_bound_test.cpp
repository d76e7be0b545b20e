// Linear bounds are valid and tight.
#include "dismantle/immobility/linear_bound.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dismantle/run_context.h"

namespace dismantle {
namespace {

Eigen::VectorXd random_vector(Rng& rng, Eigen::Index size, double most) {
  Eigen::VectorXd v(size);
  for (Eigen::Index i = 0; i < size; ++i) v[i] = rng.uniform(-most, most);
  return v;
}

template <int N>
void expect_bounds(Rng& rng, Eigen::Index n) {
  immobility::PolytopeIn<N> polytope;
  polytope.lo = -random_vector(rng, n, 1).cwiseAbs();
  polytope.hi = random_vector(rng, n, 1).cwiseAbs();
  const int rows = static_cast<int>(rng.uniform(0, 40));
  for (int r = 0; r < rows; ++r) polytope.add(random_vector(rng, n, 1), rng.uniform(0.01, 0.5));  // 0 is within
  const Eigen::Matrix<double, N, 1> direction = random_vector(rng, n, 1);
  const auto found = immobility::maximum(direction, polytope);
  ASSERT_FALSE(found.empty);
  ASSERT_TRUE(std::isfinite(found.value));
  // The returned point is in the polytope, so the bound is tight; and it holds for all points of the polytope.
  for (int r = 0; r < rows; ++r)
    EXPECT_LE(polytope.a[static_cast<std::size_t>(r)].dot(found.at), polytope.b[static_cast<std::size_t>(r)] + 1e-8);
  EXPECT_TRUE(((found.at - polytope.hi).array() <= 1e-8).all() && ((polytope.lo - found.at).array() <= 1e-8).all());
  EXPECT_NEAR(direction.dot(found.at), found.value, 1e-5);
  for (int i = 0; i < 50; ++i) {
    Eigen::VectorXd x = random_vector(rng, n, 1);
    double most = 1;  // how far along x is within
    for (Eigen::Index d = 0; d < n; ++d) most = std::min(most, (x[d] > 0 ? polytope.hi[d] : polytope.lo[d]) / x[d]);
    for (int r = 0; r < rows; ++r)
      if (const double along = polytope.a[static_cast<std::size_t>(r)].dot(x); along > 0)
        most = std::min(most, polytope.b[static_cast<std::size_t>(r)] / along);
    EXPECT_LE(direction.dot(most * x), found.value);
  }
}

TEST(LinearBound, IsReachedAndNeverExceeded) {
  Rng rng(1);
  for (int i = 0; i < 300; ++i) {
    expect_bounds<6>(rng, 6);
    expect_bounds<Eigen::Dynamic>(rng, 1 + i % 24);
  }
}

TEST(LinearBound, SaysEmptyOnlyWhereNothingIsLeft) {
  Rng rng(2);
  int empty = 0;
  for (int i = 0; i < 300; ++i) {
    immobility::Polytope polytope;
    polytope.lo.setConstant(-1);
    polytope.hi.setConstant(1);
    const immobility::Vector6 normal = random_vector(rng, 6, 1), other = random_vector(rng, 6, 1);
    const double gap = rng.uniform(-0.5, 0.5);
    polytope.add(normal, 0.1);
    polytope.add(-normal, -0.1 - gap);  // normal . x >= 0.1 + gap
    polytope.add(other, 3);
    const bool none = immobility::maximum(other, polytope).empty;
    if (gap > 1e-6) {
      EXPECT_TRUE(none);
    } else if (gap < -1e-6 && 0.1 + gap < normal.cwiseAbs().sum()) {
      EXPECT_FALSE(none);
    }
    empty += none ? 1 : 0;
  }
  EXPECT_GT(empty, 100);
}

TEST(LinearBound, NoneWhenToldToStop) {
  immobility::Polytope polytope{immobility::Vector6::Constant(-1), immobility::Vector6::Ones(), {}, {}};
  const immobility::Vector6 direction = immobility::Vector6::Ones();
  RunContext context;
  EXPECT_TRUE(std::isfinite(immobility::maximum(direction, polytope, &context).value));
  context.cancel.cancel();
  const auto stopped = immobility::maximum(direction, polytope, &context);
  EXPECT_TRUE(std::isinf(stopped.value));
  EXPECT_FALSE(stopped.empty);
}

}  // namespace
}  // namespace dismantle
