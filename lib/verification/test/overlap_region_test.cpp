// A deep overlap is allowed only in its region when assembled, in the frame of either part.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dismantle/testing/shapes.h"
#include "dismantle/testing/trials.h"
#include "dismantle/verification/contact.h"
#include "dismantle/verification/motion_depth.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {
namespace {

using shapes::box;
using shapes::joined;
using shapes::moved;
using shapes::random_pose;
using shapes::random_vector;
using shapes::shift;
using shapes::Vec3;

constexpr double kTolerance = 0.01;

/// Two parts with their overlap, as preparation measures it.
Assembly measured(const Mesh& a, const Mesh& b, bool with_place = true) {
  Assembly assembly = shapes::assembly_of({a, b});
  const DepthBody x(a), y(b);
  const Penetration deepest = deepest_penetration(x, Pose{}, y, Pose{}, 1e-4);
  InitialOverlap overlap{0, 1, deepest.depth};
  if (with_place) overlap.place = classify_overlap(x, y, deepest, 1e-4).place;
  assembly.overlaps = {overlap};
  return assembly;
}

MotionCheck check(const Assembly& assembly, const std::vector<Pose>& motion) {
  Path path;
  for (const Pose& p : motion) path.push_back({p});
  return Verifier(assembly, {kTolerance}).check_motion({0}, {{1, Pose{}}}, path);
}

/// A pin with a nose on its side, through a plate with a wall beside the path of the nose, at varying distance.
struct PinAndWall {
  Mesh pin, plate;
  PinAndWall(double press, double cut, int sides) {
    pin = joined(shapes::tube(0, 1 + press, -3, 3, sides, 2), box({1.5, -0.4, -2.9}, {2.5, 0.4, -1.9}));
    pin = joined(pin, box({0, -0.4, -2.9}, {2, 0.4, -2.3}));
    plate = shapes::tube(1, 1.4, -1, 1, sides, 1);
    plate = joined(plate, box({2.5 - cut, -1, -6}, {4, 1, -4}));  // below the plate, beside the path of the nose
  }
};

TEST(OverlapRegion, APressFitLeavesAlongItsAxisAndMayNotCutInElsewhere) {
  Rng rng(1);
  for (int trial = 0; trial < testing_support::trials(6, 60); ++trial) {
    const double press = rng.uniform(0.13, 0.2);
    const Pose world = random_pose(rng, 3);
    for (const double cut : {-0.05, 0.6 * press, 0.95 * press}) {
      const PinAndWall parts(press, cut, 24);
      const Mesh pin = moved(parts.pin, world), plate = moved(parts.plate, world);
      const Assembly assembly = measured(pin, plate);
      ASSERT_TRUE(Verifier(assembly, {kTolerance}).overlap_region(0, 1));
      const Vec3 down = world.q * Vec3(0, 0, -1);
      EXPECT_TRUE(check(assembly, {Pose{}, shift(1.05 * down)}).valid) << "trial " << trial;
      const MotionCheck past = check(assembly, {Pose{}, shift(4.5 * down)});
      EXPECT_EQ(past.valid, cut < 0) << "trial " << trial << " cut " << cut << " of " << press
                                     << (past.violation ? past.violation->uncertain ? ": uncertain" : ": found" : "");
      if (cut < 0) continue;
      ASSERT_TRUE(past.violation);
      EXPECT_TRUE(past.violation->elsewhere);
      EXPECT_GT(past.violation->depth, kTolerance);
      EXPECT_TRUE(check(measured(pin, plate, false), {Pose{}, shift(4.5 * down)}).valid) << "as deep as when assembled";
    }
  }
}

/// The border of the region crosses large faces, past which the pin slides a long way.
TEST(OverlapRegion, APinWithASlightOverlapSlidesOutOfAWidePlate) {
  Rng rng(3);
  for (int trial = 0; trial < testing_support::trials(1, 20); ++trial) {
    const double press = rng.uniform(0.03, 0.05);
    const Pose world = random_pose(rng, 3);
    const Mesh pin = moved(shapes::tube(0, 0.2 + press, -3, 1, 24, 1), world);
    const Mesh plate = moved(shapes::tube(0.2, 6, -1, 0, 24, 1), world);
    const Assembly assembly = measured(pin, plate);
    const Verifier verifier(assembly, {0.001});
    ASSERT_TRUE(verifier.overlap_region(0, 1));
    const Pose out = shift(4.5 * (world.q * Vec3(0, 0, 1)));
    EXPECT_TRUE(verifier.check_motion({0}, {{1, Pose{}}}, {{Pose{}}, {out}}).valid) << "trial " << trial;
  }
}

/// A pressed sleeve slides off a pin that is longer than itself. The region's faces cut both obliquely, and the
/// sleeve's outside is beyond them; where a facet passes a face, nothing of the other part is.
TEST(OverlapRegion, ASleeveSlidesOffItsPinInAnyPoseWithLittleWork) {
  Rng rng(5);
  for (int trial = 0; trial < testing_support::trials(4, 40); ++trial) {
    const double press = rng.uniform(0.015, 0.05), wall = rng.uniform(0.3, 1);
    const Pose world = random_pose(rng, 3);
    const Mesh sleeve = moved(shapes::tube(1, 1 + wall, 0, 3, 32, 1), world);
    const Mesh pin = moved(shapes::tube(0, 1 + press, -3, 5, 32, 1), world);
    const Assembly assembly = measured(sleeve, pin);
    const Verifier verifier(assembly, {0.001});
    ASSERT_TRUE(verifier.overlap_region(0, 1));
    const Vec3 up = world.q * Vec3(0, 0, 1);
    Path path;
    for (int k = 0; k <= 20; ++k) path.push_back({shift(0.3 * k * up)});
    const MotionCheck off = verifier.check_motion({0}, {{1, Pose{}}}, path);
    EXPECT_TRUE(off.valid) << "trial " << trial;
    EXPECT_LT(off.tests, 5000U) << "trial " << trial;
  }
}

TEST(OverlapRegion, ShallowAndDeclaredOverlapsHaveNone) {
  const Mesh a = box({0, 0, 0}, {2, 2, 2});
  for (const double depth : {0.05, 0.15}) {
    Assembly assembly = measured(a, box({2 - depth, 0, 0}, {4, 2, 2}));
    EXPECT_EQ(Verifier(assembly, {kTolerance}).overlap_region(1, 0).has_value(), depth > 0.1);
    EXPECT_TRUE(Verifier(assembly, {0.1 * depth * 0.99}).overlap_region(0, 1));
    assembly.overlaps[0].declared = 0.2;
    EXPECT_FALSE(Verifier(assembly, {kTolerance}).overlap_region(0, 1));
  }
}

/// Depth of a point in a box.
double depth_in(const Aabb& b, const Vec3& p) { return std::min((p - b.lo).minCoeff(), (b.hi - p).minCoeff()); }

struct Blocks {
  std::vector<Aabb> a, b;
};

/// Greatest sampled depth along a straight path, of points outside the region grown by `more`.
double deepest_outside(const Blocks& blocks, const Vec3& motion, Aabb region, double more) {
  region.inflate(more);
  double worst = 0;
  constexpr int kTimes = 80, kGrid = 12;
  for (const bool forward : {true, false})
    for (const Aabb& of : forward ? blocks.a : blocks.b)
      for (int face = 0; face < 6; ++face)
        for (int i = 0; i <= kGrid; ++i)
          for (int k = 0; k <= kGrid; ++k) {
            Vec3 p = face % 2 == 0 ? of.lo : of.hi;
            const int u = (face / 2 + 1) % 3, v = (face / 2 + 2) % 3;
            p[u] = of.lo[u] + (of.hi[u] - of.lo[u]) * i / kGrid;
            p[v] = of.lo[v] + (of.hi[v] - of.lo[v]) * k / kGrid;
            if (region.contains(p)) continue;
            for (int t = 0; t <= kTimes; ++t) {
              const Vec3 x = p + (forward ? 1.0 : -1.0) * t / kTimes * motion;
              if (region.contains(x)) continue;
              for (const Aabb& in : forward ? blocks.b : blocks.a) worst = std::max(worst, depth_in(in, x));
            }
          }
  return worst;
}

/// A block that overlaps another slides along it, past a third block that it may penetrate as deep.
TEST(OverlapRegion, AgreesWithSamplesOnRandomBlocks) {
  Rng rng(2);
  int refused = 0, accepted = 0, unclear = 0;
  for (int trial = 0; trial < testing_support::trials(60, 1000); ++trial) {
    const double deep = rng.uniform(0.12, 0.2), past = rng.uniform(-0.1, 0.95) * deep;
    const double length = rng.uniform(0.4, 3), from = rng.uniform(-0.6, 0.6), gap = rng.uniform(0, 2.5);
    Blocks blocks;
    blocks.a = {{Vec3(0, 0, 0), Vec3(length, 1, 1)}};
    blocks.b = {{Vec3(from, 1 - deep, -0.2), Vec3(from + rng.uniform(0.5, 2), 2, 1.2)}};
    const double beyond = std::max(blocks.b[0].hi.x(), length) + gap;
    blocks.b.push_back({Vec3(beyond, 1 - past, -0.2), Vec3(beyond + 0.5, 2, 1.2)});
    if (rng.below(2) == 0) blocks.b.push_back({Vec3(-3, -2, -0.2), Vec3(beyond + 4, -0.3, 1.2)});
    const Vec3 displacement(beyond + 1 + length, 0, 0);
    const Assembly assembly = measured(shapes::boxes(blocks.a), shapes::boxes(blocks.b));
    const auto region = Verifier(assembly, {kTolerance}).overlap_region(0, 1);
    if (!region) continue;  // it is not in the other far enough along the way
    const MotionCheck seen = check(assembly, {Pose{}, shift(displacement)});
    const bool valid = seen.valid;
    if (deepest_outside(blocks, displacement, *region, 0.02) > 1.3 * kTolerance) {
      EXPECT_FALSE(valid) << "trial " << trial;
      ++refused;
    } else if (deepest_outside(blocks, displacement, *region, -0.05) < 0.4 * kTolerance) {
      EXPECT_TRUE(valid) << "trial " << trial << ": " << seen.violation.value_or(Violation{}).depth << " deep at "
                         << seen.violation.value_or(Violation{}).point.transpose()
                         << (seen.violation.value_or(Violation{}).uncertain ? ", uncertain" : "");
      ++accepted;
    } else {
      ++unclear;
    }
  }
  EXPECT_GT(refused, 10);
  EXPECT_GT(accepted, 5);
  EXPECT_LT(unclear, refused + accepted);
}

// The depth that is measured along a straight motion counts what lies outside the region, wherever on the way: a block
// that overlaps another, past up to three more, in any direction.
TEST(OverlapRegion, TheDepthOfAMotionIsThatOfSamplesOutsideOfIt) {
  Rng rng(3);
  int deep = 0;
  for (int trial = 0; trial < testing_support::trials(40, 600); ++trial) {
    Blocks blocks;
    blocks.a = {{Vec3(0, 0, 0), Vec3(rng.uniform(0.4, 3), 1, 1)}};
    blocks.b = {{Vec3(-0.3, 1 - rng.uniform(0.2, 0.4), -0.2), Vec3(rng.uniform(0.5, 2), 2, 1.2)}};
    for (std::uint64_t k = rng.below(4); k > 0; --k) {
      const Vec3 at(rng.uniform(3.5, 6), rng.uniform(-1.5, 1.8), rng.uniform(-1, 1));
      blocks.b.push_back({at, at + Vec3(rng.uniform(0.3, 1), rng.uniform(0.3, 1), rng.uniform(0.3, 1))});
    }
    const Vec3 displacement(9, rng.uniform(-0.3, 0.3), rng.uniform(-0.5, 0.5));
    const Assembly assembly = measured(shapes::boxes(blocks.a), shapes::boxes(blocks.b));
    const Verifier verifier(assembly, {kTolerance});
    const auto region = verifier.overlap_region(0, 1);
    if (!region) continue;
    const double allowed = assembly.initial_overlap(0, 1);
    const auto found = MotionDepthMeter(assembly, verifier)
                           .deepest({0}, {{1, Pose{}}}, {{Pose{}}, {shift(displacement)}},
                                    {.absolute = 0.5 * kTolerance, .relative = 0.02}, RunContext{});
    const double excess = found ? found->excess() : 0;
    const double least = deepest_outside(blocks, displacement, *region, 1e-3);
    EXPECT_GT(excess, 0.97 * least - kTolerance) << "trial " << trial;
    // Nothing is deeper than what the samples find anywhere, but for what lies between them.
    const double most = std::max(deepest_outside(blocks, displacement, *region, -0.03),
                                 deepest_outside(blocks, displacement, Aabb{}, 0) - allowed);
    EXPECT_LT(excess, 1.05 * most + 0.1) << "trial " << trial;
    if (found) {
      EXPECT_TRUE(found->proved) << "trial " << trial;
    }
    deep += least > 0.1 ? 1 : 0;
  }
  EXPECT_GT(deep, 10);
}

}  // namespace
}  // namespace dismantle
