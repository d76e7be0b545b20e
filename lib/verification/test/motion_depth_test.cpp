// Depth of a motion against closed forms, and against brute force over many poses.
#include "dismantle/verification/motion_depth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/testing/trials.h"
#include "dismantle/verification/contact.h"

namespace dismantle {
namespace {

using shapes::shift;
using shapes::Vec3;

MotionDepth deepest(const Assembly& assembly, const std::vector<PlacedPart>& fixed, const Path& path,
                    MotionDepthOptions options = {}) {
  const Verifier verifier(assembly, {.max_penetration = 0.01});
  MotionDepthMeter meter(assembly, verifier);
  const RunContext context;
  const auto found = meter.deepest({0}, fixed, path, options, context);
  return found.value_or(MotionDepth{});
}

TEST(MotionDepth, ACubeThroughAWall) {
  Rng rng(7);
  for (int i = 0; i < 12; ++i) {
    // Either the middle of the wall is deepest in the cube, or the cube in the wall.
    const double size = rng.uniform(0.2, 1), wall = rng.uniform(0.1, 1.5);
    const Pose world = shapes::random_pose(rng, 2);
    const Assembly assembly =
        shapes::assembly_of({shapes::moved(shapes::box(Vec3::Constant(-size / 2), Vec3::Constant(size / 2)), world),
                             shapes::moved(shapes::box({1, -3, -3}, {1 + wall, 3, 3}), world)});
    const Path path{{Pose{}}, {shift(world.q * Vec3(3 + wall, 0, 0))}};
    const MotionDepth found = deepest(assembly, {{1, Pose{}}}, path, {.absolute = 0.005, .relative = 0.01});
    EXPECT_TRUE(found.proved);
    EXPECT_EQ(found.part, 0U);
    EXPECT_EQ(found.other, 1U);
    // The wall's face in the middle of the cube; the cube's face in the middle of the wall.
    EXPECT_NEAR(found.depth, std::max(size, wall) / 2, 0.005 + 0.01 * found.depth)
        << "size " << size << ", wall " << wall;
  }
}

TEST(MotionDepth, WhatPassesCutsInNowhere) {
  const Assembly assembly =
      shapes::assembly_of({shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({0, 1.001, 0}, {1, 2, 1})});
  EXPECT_EQ(deepest(assembly, {{1, Pose{}}}, {{Pose{}}, {shift({3, 0, 0})}}).depth, 0);
}

TEST(MotionDepth, TheOverlapWhenAssembledIsNotExcess) {
  // A peg 0.1 too thick, pulled along its hole, has the same depth on the whole path.
  const Assembly assembly = shapes::assembly_of(
      {shapes::tube(0, 1.1, -2, 2, 32, 3), shapes::tube(1, 2, -1.5, 1.5, 32, 3)}, {{0, 1, 0.1 * std::cos(M_PI / 32)}});
  const MotionDepth found = deepest(assembly, {{1, Pose{}}}, {{Pose{}}, {shift({0, 0, 4})}});
  EXPECT_LT(found.excess(), 0.02);
}

TEST(MotionDepth, OfALongEqualCutIsProvedWithFewPoses) {
  // A slide 0.05 too wide for the rail on which it moves by 20: one pose in 0.01 would have to be measured.
  const Assembly assembly =
      shapes::assembly_of({shapes::box({0, -0.5, 0.95}, {1, 0.5, 2}), shapes::box({2, -1, -1}, {22, 1, 1})});
  const MotionDepth found = deepest(assembly, {{1, Pose{}}}, {{Pose{}}, {shift({24, 0, 0})}},
                                    {.absolute = 0.005, .relative = 0.01, .most_poses = 40});
  EXPECT_TRUE(found.proved);
  EXPECT_NEAR(found.depth, 0.05, 0.005);
}

TEST(MotionDepth, ABoundThatIsKnownChangesNothingButTheEffort) {
  Rng rng(5);
  for (int i = 0; i < 12; ++i) {
    const double size = rng.uniform(0.2, 1), wall = rng.uniform(0.1, 1.5), depth = std::max(size, wall) / 2;
    const Assembly assembly = shapes::assembly_of(
        {shapes::box(Vec3::Constant(-size / 2), Vec3::Constant(size / 2)), shapes::box({1, -3, -3}, {1 + wall, 3, 3})});
    const Path path{{Pose{}}, {shift({3 + wall, 0, 0})}};
    MotionDepthOptions options{.absolute = 0.005, .relative = 0.01};
    const double free = deepest(assembly, {{1, Pose{}}}, path, options).depth;
    options.at_most = depth + rng.uniform(0, 0.5);
    EXPECT_NEAR(deepest(assembly, {{1, Pose{}}}, path, options).depth, free, 0.005 + 0.01 * depth);
  }
}

TEST(MotionDepth, AgreesWithBruteForceOnScrewMotions) {
  Rng rng(11);
  for (int i = 0; i < 4; ++i) {
    const Mesh a = shapes::box(shapes::random_vector(rng, -1, -0.3), shapes::random_vector(rng, 0.3, 1));
    const Mesh b = i % 2 == 0 ? shapes::sphere({0, 0, 0}, rng.uniform(0.5, 1), 2) : shapes::tube(0.5, 1, -0.5, 0.5, 12);
    const Assembly assembly = shapes::assembly_of({a, b});
    const Pose from = shapes::random_pose(rng, 2), middle = shapes::random_pose(rng, 1),
               to = shapes::random_pose(rng, 2);
    const Path path{{from}, {middle}, {to}};
    const MotionDepth found = deepest(assembly, {{1, Pose{}}}, path, {.absolute = 0.01, .relative = 0.02});
    double brute = 0;
    const DepthBody body_a(a), body_b(b);
    constexpr int kPoses = 120;
    for (int k = 0; k <= kPoses; ++k)
      for (std::size_t s = 0; s < 2; ++s) {
        const Pose pose = screw_interpolate(path[s][0], path[s + 1][0], static_cast<double>(k) / kPoses);
        brute = std::max(brute, penetration_depth(body_a, pose, body_b, Pose{}, 5e-3));
      }
    EXPECT_TRUE(found.proved);
    EXPECT_GE(found.depth, brute - std::max(0.01, 0.02 * brute) - 5e-3) << "trial " << i;
    EXPECT_LE(found.depth, brute + std::max(0.05, 0.02 * brute)) << "trial " << i;  // brute force misses instants
  }
}

TEST(MotionDepth, AgreesWithBruteForceOnStraightMotions) {
  Rng rng(29);
  for (int i = 0; i < testing_support::trials(9, 120); ++i) {
    const auto solid = [&](int kind) {
      if (kind == 0) return shapes::box(shapes::random_vector(rng, -1, -0.3), shapes::random_vector(rng, 0.3, 1));
      if (kind == 1) return shapes::sphere({0, 0, 0}, rng.uniform(0.5, 1), 1);
      return shapes::tube(rng.uniform(0.2, 0.5), rng.uniform(0.7, 1), -0.5, rng.uniform(0, 1), 12);
    };
    const Mesh a = shapes::moved(solid(i % 3), shapes::random_pose(rng, 0.5)),
               b = shapes::moved(solid(i / 3 % 3), shapes::random_pose(rng, 0.5));
    const Assembly assembly = shapes::assembly_of({a, b});
    const Pose from = shapes::random_pose(rng, 1);
    const Vec3 first = shapes::random_vector(rng, -2, 2), second = shapes::random_vector(rng, -2, 2);
    const Path path{{{from.t - first, from.q}}, {from}, {{from.t + second, from.q}}};
    const MotionDepth found = deepest(assembly, {{1, Pose{}}}, path, {.absolute = 0.01, .relative = 0.02});
    Penetration brute;
    const DepthBody body_a(a), body_b(b);
    constexpr int kPoses = 80;
    for (int k = 0; k <= kPoses; ++k)
      for (std::size_t s = 0; s < 2; ++s) {
        const Pose pose = screw_interpolate(path[s][0], path[s + 1][0], static_cast<double>(k) / kPoses);
        const Penetration there = deepest_penetration(body_a, pose, body_b, Pose{}, 5e-3);
        if (there.depth > brute.depth) brute = there;
      }
    EXPECT_TRUE(found.proved || brute.depth == 0) << "trial " << i;
    EXPECT_GE(found.depth, brute.depth - std::max(0.01, 0.02 * brute.depth)) << "trial " << i;
    EXPECT_LE(found.depth, brute.depth + 0.04) << "trial " << i;  // brute force misses instants
    if (found.depth < 0.1) continue;
    // The point is one of the surface of the one or the other at some instant, so deep in the other.
    double depth = 0;
    for (int k = 0; k <= kPoses; ++k)
      for (std::size_t s = 0; s < 2; ++s) {
        const Pose pose = screw_interpolate(path[s][0], path[s + 1][0], static_cast<double>(k) / kPoses);
        const TriangleBvh there_a(shapes::moved(a, pose)), there_b(b);
        const double in_a = -there_a.signed_distance(found.point), in_b = -there_b.signed_distance(found.point);
        if (std::abs(in_a) < 0.03) depth = std::max(depth, in_b);
        if (std::abs(in_b) < 0.03) depth = std::max(depth, in_a);
      }
    EXPECT_NEAR(depth, found.depth, 0.05) << "trial " << i;
  }
}

/// The head of a rivet, through a bore: as deep all along the way, and deepest on ridges of the one and of the other.
TEST(MotionDepth, AHeadThroughALongBoreIsProvedWithLittleWork) {
  Rng rng(31);
  for (int i = 0; i < testing_support::trials(6, 60); ++i) {
    const double bore = rng.uniform(0.4, 0.8), wall = rng.uniform(0.3, 1), rim = bore + wall * rng.uniform(0.2, 0.8),
                 thickness = rng.uniform(0.2, 0.8);
    const Pose world = shapes::random_pose(rng, 2);
    const Assembly assembly =
        shapes::assembly_of({shapes::moved(shapes::tube(0, rim, -1 - thickness, -1, 48), world),
                             shapes::moved(shapes::tube(bore, bore + wall, 0, rng.uniform(5, 12), 48), world)});
    const MotionDepth found = deepest(assembly, {{1, Pose{}}}, {{Pose{}}, {shift(world.q * Vec3(0, 0, 15))}},
                                      {.absolute = 0.005, .relative = 0.05, .most_poses = 200});
    // A face of the head in the wall, or the edge of the bore in the head; facets of 48 are 0.2 % less far out.
    const double in_wall = std::min(rim - bore, 0.5 * wall), in_head = std::min(rim - bore, 0.5 * thickness);
    const double depth = std::max(in_wall, in_head);
    EXPECT_TRUE(found.proved) << "trial " << i;
    EXPECT_NEAR(found.depth, depth, 0.06 * depth) << "trial " << i;
  }
}

/// A pressed pin whose nose passes a wall below the plate. The nose cuts in less than the pin does when assembled.
TEST(MotionDepth, OutsideTheOverlapWhenAssembledAllIsExcess) {
  Rng rng(13);
  for (int i = 0; i < testing_support::trials(2, 20); ++i) {
    const double press = rng.uniform(0.15, 0.25), cut = press * rng.uniform(0.3, 0.95);
    const Pose world = shapes::random_pose(rng, 2);
    const Mesh pin = shapes::joined(
        shapes::joined(shapes::tube(0, 1 + press, -3, 3, 24, 2), shapes::box({1.5, -0.4, -2.9}, {2.5, 0.4, -1.9})),
        shapes::box({0, -0.4, -2.9}, {2, 0.4, -2.3}));
    const Mesh plate = shapes::joined(shapes::tube(1, 1.4, -1, 1, 24, 1), shapes::box({2.5 - cut, -1, -6}, {4, 1, -4}));
    Assembly assembly = shapes::assembly_of({shapes::moved(pin, world), shapes::moved(plate, world)});
    const DepthBody x(*assembly.parts[0].mesh), y(*assembly.parts[1].mesh);
    const Penetration assembled = deepest_penetration(x, Pose{}, y, Pose{}, 1e-4);
    ASSERT_GT(assembled.depth, cut);
    const Path path{{Pose{}}, {shift(world.q * Vec3(0, 0, -4.5))}};
    assembly.overlaps = {{0, 1, assembled.depth}};
    EXPECT_LT(deepest(assembly, {{1, Pose{}}}, path, {.absolute = 5e-3, .relative = 0.05}).excess(), 0.01);
    assembly.overlaps[0].place = classify_overlap(x, y, assembled, 1e-4).place;
    const MotionDepth found = deepest(assembly, {{1, Pose{}}}, path, {.absolute = 5e-3, .relative = 0.05});
    EXPECT_TRUE(found.proved) << "trial " << i;
    EXPECT_EQ(found.allowed, 0);
    EXPECT_NEAR(found.depth, cut, 5e-3 + 0.05 * cut) << "trial " << i;
  }
}

/// A block slides along a floor that it lies in, over a ridge that it cuts deeper into, anywhere on the way.
TEST(MotionDepth, ARidgeInAUniformOverlapIsFound) {
  Rng rng(19);
  for (int i = 0; i < testing_support::trials(10, 100); ++i) {
    const double sunk = rng.uniform(0.05, 0.2), ridge = sunk * rng.uniform(0.1, 1.5), at = rng.uniform(3, 8);
    const Pose world = shapes::random_pose(rng, 2);
    const Mesh floor = shapes::joined(shapes::box({-5, -2, -2}, {15, 2, 0}),
                                      shapes::box({at, -0.5, -1}, {at + rng.uniform(0.02, 0.1), 0.5, ridge}));
    const Assembly assembly = shapes::assembly_of(
        {shapes::moved(shapes::box({-1, -1, -sunk}, {1, 1, 2}), world), shapes::moved(floor, world)});
    const MotionDepth found = deepest(assembly, {{1, Pose{}}}, {{Pose{}}, {shift(world.q * Vec3(10, 0, 0))}},
                                      {.absolute = 2e-3, .relative = 0.05});
    EXPECT_TRUE(found.proved) << "trial " << i;
    EXPECT_NEAR(found.depth, sunk + ridge, std::max(2e-3, 0.05 * (sunk + ridge))) << "trial " << i;
  }
}

/// One pair is `known` deep. Another begins and ends at 0.55 to 0.75 of that, where one coarse pass is enough, and is
/// deeper between: what the coarse pass found has to count in the bound.
TEST(MotionDepth, WhatIsFoundLessDeepCountsInTheBoundOfWhatIsBetween) {
  Rng rng(23);
  for (int i = 0; i < testing_support::trials(10, 100); ++i) {
    const double known = rng.uniform(0.5, 2), half = known * rng.uniform(1.15, 1.3),
                 at = known * rng.uniform(0.55, 0.75);
    const Pose world = shapes::random_pose(rng, 2);
    const Vec3 grain = Vec3::Constant(0.005 * known);
    const auto slab = [&](double y, double thickness) {
      return shapes::moved(shapes::box({0, y - 9, -9}, {thickness, y + 9, 9}), world);
    };
    const auto grain_at = [&](double x, double y) {
      return shapes::moved(shapes::box(Vec3(x, y, 0) - grain, Vec3(x, y, 0) + grain), world);
    };
    const Assembly assembly =
        shapes::assembly_of({grain_at(known, 0), grain_at(at, 30), slab(0, 2 * known), slab(30, 2 * half)});
    const Verifier verifier(assembly, {.max_penetration = 0.01});
    MotionDepthMeter meter(assembly, verifier);
    const Path path{{Pose{}, Pose{}}, {Pose{}, shift(world.q * Vec3(2 * (half - at), 0, 0))}};
    const auto found =
        meter.deepest({0, 1}, {{2, Pose{}}, {3, Pose{}}}, path, {.absolute = 2e-3, .relative = 0.02}, RunContext{});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->part, 1U);
    EXPECT_NEAR(found->depth, half, 0.03 * half) << "known " << known << ", at the ends " << at;
  }
}

TEST(MotionDepth, StopsWhenToldTo) {
  const Assembly assembly = shapes::assembly_of({shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({2, 0, 0}, {3, 1, 1})});
  const Verifier verifier(assembly, VerifyOptions{});
  MotionDepthMeter meter(assembly, verifier);
  RunContext context;
  context.cancel.cancel();
  EXPECT_FALSE(meter.deepest({0}, {{1, Pose{}}}, {{Pose{}}, {shift({5, 0, 0})}}, {}, context));
}

}  // namespace
}  // namespace dismantle
