#include <gtest/gtest.h>

#include <limits>

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/verification/interruptible_depth.h"
#include "dismantle/verification/verifier.h"
#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

using shapes::random_pose;
using shapes::shift;
using shapes::Vec3;

constexpr double kTolerance = 1e-4;

/// Both orders, placed by `world`; the answer may fall short by the tolerance and never exceeds.
void expect_depth(const Mesh& a, const Mesh& b, const Pose& world, double depth, double rounding = 1e-9) {
  for (const double found :
       {penetration_depth(a, world, b, world, kTolerance), penetration_depth(b, world, a, world, kTolerance)}) {
    EXPECT_GE(found, depth - kTolerance);
    EXPECT_LE(found, depth + rounding);
  }
}

TEST(PenetrationDepth, BoxesOverlappingByD) {
  Rng rng(1);
  for (int i = 0; i < 20; ++i) {
    const double d = rng.uniform(0, 0.3);
    expect_depth(shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({1 - d, -1, -1}, {3, 2, 2}), random_pose(rng, 3), d);
  }
}

TEST(PenetrationDepth, FlushFacesAndNoiseAreNothing) {
  Rng rng(2);
  const Mesh a = shapes::refine(shapes::box({0, 0, 0}, {1, 1, 1}), 3);
  for (const double d : {0.0, 1e-7, -1e-7}) {
    expect_depth(a, shapes::refine(shapes::box({1 - d, 0, 0}, {2, 1, 1}), 2), random_pose(rng, 3), std::max(0.0, d));
    expect_depth(a, shapes::box({1 - d, 0.3, -1}, {2, 0.7, 4}), random_pose(rng, 3), std::max(0.0, d));
  }
  // In a pocket of its own size, flush all around.
  expect_depth(a, shapes::closed_box({-1, -1, -1}, {2, 2, 2}, 1.0), random_pose(rng, 3), 0);
}

TEST(PenetrationDepth, ShaftTooThickForItsHole) {
  Rng rng(3);
  for (const double d : {0.0, 0.001, 0.05}) {
    // The same outline, so that facets match: radius differs by d, facet distance by d cos(pi / n).
    const Mesh shaft = shapes::tube(0, 1 + d, -2, 2, 64, 3), sleeve = shapes::tube(1, 2, -1.5, 1.5, 64, 3);
    expect_depth(shaft, sleeve, random_pose(rng, 3), d, 1e-9);
  }
}

TEST(PenetrationDepth, BallDippingIntoABox) {
  Rng rng(4);
  expect_depth(shapes::sphere({0, 0, 0.98}, 1, 4), shapes::box({-2, -2, -2}, {2, 2, 0}), random_pose(rng, 3), 0.02);
}

TEST(PenetrationDepth, InsideAVoidIsOutside) {
  const Mesh house = shapes::closed_box({-2, -2, -2}, {2, 2, 2}, 0.1);
  EXPECT_EQ(penetration_depth(house, {}, shapes::box({-1, -1, -1}, {1, 1, 1}), {}, kTolerance), 0);
  // A wall of 0.1 with a box through it: the box's points are at most half of the wall deep, but the wall's are 1 deep.
  EXPECT_NEAR(penetration_depth(house, {}, shapes::box({-1, -1, -1}, {3, 1, 1}), {}, kTolerance), 1, kTolerance);
}

TEST(PenetrationDepth, BodyWhollyInsideAnother) {
  // The far corners of the inner box are 1.5 away from the outer surface, its faces' centres too.
  EXPECT_NEAR(penetration_depth(shapes::box({-.5, -.5, -.5}, {.5, .5, .5}), {}, shapes::box({-2, -2, -2}, {2, 2, 2}),
                                {}, kTolerance),
              1.5, kTolerance);
}

TEST(PenetrationDepth, OverlappingShellsHideNothing) {
  // Two slabs that overlap about the plane z = 0: on that surface lies the top of the box, whose sides are half as deep
  // in the lower slab as that is thick.
  Mesh pair = shapes::box({-2, -2, -2}, {2, 2, 0.01});
  shapes::append(pair, shapes::box({-2, -2, -0.01}, {2, 2, 2}));
  EXPECT_NEAR(penetration_depth(shapes::box({-.5, -.5, -1}, {.5, .5, 0}), {}, pair, {}, kTolerance), 1.005, kTolerance);
}

TEST(PenetrationDepth, AgreesWithSampling) {
  Rng rng(5);
  for (int i = 0; i < 10; ++i) {
    const Mesh a = shapes::tube(0.5, 1, -1, 1, 12, 2), b = shapes::box({-0.7, -0.7, -0.7}, {0.7, 0.7, 0.7});
    const Pose pa = random_pose(rng, 0.8), pb = random_pose(rng, 0.8);
    const Mesh wa = shapes::moved(a, pa), wb = shapes::moved(b, pb);
    const TriangleBvh ta(wa), tb(wb);
    double sampled = 0;
    const auto sample = [&](const Mesh& from, const TriangleBvh& into) {
      for (std::size_t t = 0; t < from.triangles.size(); ++t)
        for (int k = 0; k < 200; ++k) {
          double u = rng.uniform(), v = rng.uniform();
          if (u + v > 1) u = 1 - u, v = 1 - v;
          const Vec3 p = from.vertex(t, 0) + u * (from.vertex(t, 1) - from.vertex(t, 0)) +
                         v * (from.vertex(t, 2) - from.vertex(t, 0));
          sampled = std::max(sampled, -into.signed_distance(p));
        }
    };
    sample(wa, tb);
    sample(wb, ta);
    const double found = penetration_depth(a, pa, b, pb, 1e-3);
    EXPECT_GE(found, sampled - 1e-3);
    EXPECT_LE(found, sampled + 0.1);  // samples miss the deepest point by about their spacing
    EXPECT_EQ(found, penetration_depth(DepthBody(a), pa, DepthBody(b), pb, 1e-3));
  }
}

/// Two balls that are slow to settle: the depth found before the first stop check is less than the true one.
TEST(PenetrationDepth, ToldToStopItIsALowerBoundOfLittleWork) {
  Rng rng(9);
  RunContext stopped;
  stopped.cancel.cancel();
  int less = 0;
  for (int i = 0; i < 10; ++i) {
    const DepthBody a(shapes::sphere({0, 0, 0}, 1, 3)), b(shapes::sphere(rng.uniform(0.3, 1) * Vec3::UnitX(), 1, 3));
    const Pose world = random_pose(rng, 3);
    const double whole = penetration_depth(a, world, b, world, kTolerance);
    const double found = deepest_penetration(a, world, b, world, {kTolerance}, stopped).depth;
    EXPECT_LE(found, whole + kTolerance);
    less += found < whole - kTolerance ? 1 : 0;
  }
  EXPECT_GT(less, 5);
}

/// What is known already is not searched for again, and a depth that is enough ends the search.
TEST(PenetrationDepth, SearchesBetweenWhatIsKnownAndWhatIsEnough) {
  Rng rng(17);
  const RunContext context;
  for (int i = 0; i < 10; ++i) {
    const DepthBody a(shapes::sphere({0, 0, 0}, 1, 3)), b(shapes::sphere(rng.uniform(0.3, 1) * Vec3::UnitX(), 1, 3));
    const Pose world = random_pose(rng, 3);
    const double whole = penetration_depth(a, world, b, world, kTolerance);
    const auto found = [&](double from, double enough) {
      return deepest_penetration(a, world, b, world, {.tolerance = kTolerance, .from = from, .enough = enough}, context)
          .depth;
    };
    const double endless = std::numeric_limits<double>::infinity(), less = rng.uniform(0.1, 0.9) * whole;
    EXPECT_NEAR(found(less, endless), whole, 2 * kTolerance);
    EXPECT_EQ(found(whole + 2 * kTolerance, endless), whole + 2 * kTolerance);
    EXPECT_GE(found(0, less), less);
    EXPECT_LE(found(0, less), whole + kTolerance);
  }
}

TEST(PenetrationDepth, ToleranceMustBePositive) {
  const Mesh m = shapes::box({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(penetration_depth(m, {}, m, {}, 0), std::invalid_argument);
  EXPECT_THROW(penetration_depth(m, {}, m, {}, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace dismantle
