// The linear form of the relative coordinates of two bodies is exact up to the remainder that it states.
#include "interlock_lp/relative_coordinates.h"

#include <gtest/gtest.h>

#include "dismantle/pose.h"
#include "dismantle/run_context.h"

namespace dismantle {
namespace {

using Eigen::Vector3d;
using immobility::Vector6;

Vector3d random_vector(Rng& rng, double most) {
  return most * Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
}

/// Coordinates that use all, or about, of what is allowed.
Vector6 within(Rng& rng, const Vector6& most) {
  Vector6 x = most;
  for (int i = 0; i < 6; ++i) x[i] *= rng.uniform(0, 1) < 0.5 ? rng.uniform(-1, 1) : (rng.uniform(0, 1) < 0.5 ? -1 : 1);
  return x;
}

TEST(RelativeCoordinates, AreLinearUpToTheRemainder) {
  Rng rng(1);
  double worst = 0;
  for (int i = 0; i < 20'000; ++i) {
    immobility::CoordinateBound a, b;
    const double turn = i % 3 == 0 ? 0.144 : rng.uniform(0, 0.144), shift = rng.uniform(0, 0.2);
    a.most << random_vector(rng, turn).cwiseAbs(), random_vector(rng, shift).cwiseAbs();
    if (i % 4 != 0) b.most << random_vector(rng, turn).cwiseAbs(), random_vector(rng, shift).cwiseAbs();
    ASSERT_TRUE(a.small() && b.small());
    const Vector3d arm = random_vector(rng, 2);
    const Vector6 x = within(rng, a.most), y = within(rng, b.most);
    // Exactly: a's centre is at `arm` from b's.
    const Eigen::Quaterniond qa = rotation_from_vector(x.head<3>()), qb = rotation_from_vector(y.head<3>());
    Vector6 seen;
    seen.head<3>() = rotation_vector(qb.conjugate() * qa);
    seen.tail<3>() = qb.conjugate() * (arm + x.tail<3>() - y.tail<3>()) - arm;
    const immobility::RelativeCoordinates linear = immobility::relative_coordinates(a, b, arm, seen.cwiseAbs());
    const Vector6 off = (seen - linear.of_a * x - linear.of_b * y).cwiseAbs();
    EXPECT_TRUE((off.array() <= linear.rest.array() + 1e-12).all()) << off.transpose() << "\n"
                                                                    << linear.rest.transpose();
    for (int k = 0; k < 6; ++k)
      if (linear.rest[k] > 1e-3) worst = std::max(worst, off[k] / linear.rest[k]);
  }
  EXPECT_GT(worst, 0.6) << "the bound of the remainder is tight";
}

}  // namespace
}  // namespace dismantle
