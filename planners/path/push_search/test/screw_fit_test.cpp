// Two poses on a screw determine it, even if the rough screw is slightly wrong.
#include "dismantle/push_search/screw_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "dismantle/run_context.h"

namespace dismantle::push {
namespace {

using Eigen::Vector3d;

Vector3d any(Rng& rng) { return {rng.normal(), rng.normal(), rng.normal()}; }

struct Screw {
  Vector3d axis, point;
  double pitch;  ///< per rad, either hand
  Pose operator()(const Pose& from, double angle) const {
    const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, axis));
    return {q * (from.t - point) + point + pitch * angle * axis, q * from.q};
  }
  geometry::Twist at(const Vector3d& x) const { return {axis.cross(x - point) + pitch * axis, axis}; }
};

TEST(FittedScrew, GoesThroughAllPosesOfTheScrew) {
  Rng rng(11);
  int told = 0;
  for (int round = 0; round < 400; ++round) {
    const Screw screw{any(rng).normalized(), any(rng), 0.5 * rng.normal()};
    const Pose from{any(rng), rotation_from_vector(any(rng))};
    const Vector3d center = 0.3 * any(rng);
    const double turned = rng.uniform(0.3, 60), radius = rng.uniform(0.3, 3);
    if (std::abs(std::sin(turned / 2)) < 0.35) continue;  // the rotation does not determine its axis
    ++told;
    const Pose to = screw(from, turned);
    const Screw off{(screw.axis + 0.03 * any(rng)).normalized(), screw.point + 0.1 * any(rng),
                    screw.pitch * rng.uniform(0.7, 1.3)};
    const geometry::Twist fit =
        fitted_screw(off.at(to * center), from, to, center, radius, turned + rng.uniform(-1.5, 1.5));
    ASSERT_NEAR(fit.linear.norm() + radius * fit.angular.norm(), 1, 1e-9);
    for (int k = 0; k < 5; ++k) {
      const double angle = turned * k / 4;  // back from the end
      const Pose is = geometry::moved_along(to, fit, to * center, -angle / fit.angular.norm());
      const Pose wanted = screw(from, turned - angle);
      ASSERT_LT((is * center - wanted * center).norm(), 1e-6) << round;
      ASSERT_LT(angle_between(is.q, wanted.q), 1e-6) << round;
    }
  }
  EXPECT_GT(told, 200);
}

TEST(FittedScrew, OfAStraightWayIsATranslation) {
  Rng rng(12);
  for (int round = 0; round < 50; ++round) {
    const Vector3d displacement = any(rng);
    const Pose from{any(rng), rotation_from_vector(any(rng))}, to{from.t + displacement, from.q};
    const geometry::Twist fit = fitted_screw({displacement, Vector3d::Zero()}, from, to, any(rng), 1, 0);
    EXPECT_TRUE(fit.angular.isZero(0));
    EXPECT_LT((fit.linear - displacement.normalized()).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace dismantle::push
