// Loops in planes: their hulls and widths.
#include "dismantle/immobility/section.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dismantle/run_context.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

/// Points in a random plane: once around a star, anywhere, on a line, or several in one place.
Loop random_loop(Rng& rng, int kind) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(rng.normal(), rng.normal(), rng.normal(), rng.normal()).normalized();
  Loop loop;
  loop.plane = {q * Vec3::UnitZ(), rng.normal()};
  const auto add = [&](double x, double y) { loop.points.push_back(q * Vec3(x, y, loop.plane.offset)); };
  const auto n = 1 + rng.below(60);
  for (std::uint64_t k = 0; k < n; ++k) {
    const double a = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n), r = rng.uniform(0.2, 1);
    if (kind == 0)
      add(r * std::cos(a), r * std::sin(a));
    else if (kind == 1)
      add(rng.normal(), rng.normal());
    else if (kind == 2)
      add(r, 0);
    else
      add(static_cast<double>(rng.below(3)), static_cast<double>(rng.below(3)));
  }
  return loop;
}

TEST(Loop, ItsDiameterIsTheLargestDistanceOfTwoPoints) {
  Rng rng(8);
  for (int trial = 0; trial < 2000; ++trial) {
    const Loop loop = random_loop(rng, trial % 4);
    double largest = 0;
    for (const Vec3& a : loop.points)
      for (const Vec3& b : loop.points) largest = std::max(largest, (a - b).norm());
    ASSERT_NEAR(loop.diameter(), largest, 1e-12) << "trial " << trial;
  }
}

TEST(Loop, AllPointsAreOnOneSideOfEachEdgeOfItsHull) {
  Rng rng(9);
  for (int trial = 0; trial < 2000; ++trial) {
    const Loop loop = random_loop(rng, trial % 4);
    const std::vector<std::size_t> hull = loop.hull();
    std::vector<std::size_t> once = hull;
    std::sort(once.begin(), once.end());
    ASSERT_TRUE(std::adjacent_find(once.begin(), once.end()) == once.end());
    if (hull.size() < 3) continue;
    double sign = 0;
    for (std::size_t k = 0; k < hull.size(); ++k) {
      const Vec3 &a = loop.points[hull[k]], &b = loop.points[hull[(k + 1) % hull.size()]];
      ASSERT_GT((b - a).norm(), 0);
      for (const Vec3& p : loop.points) {
        const double side = (b - a).normalized().cross(p - a).dot(loop.plane.normal);
        if (std::abs(side) < 1e-9) continue;
        if (sign == 0) sign = side;
        ASSERT_GT(side * sign, 0) << "trial " << trial;
      }
    }
  }
}

}  // namespace
}  // namespace dismantle::immobility
