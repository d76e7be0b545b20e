#include "dismantle/verification/verifier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <thread>

#include "dismantle/geometry/hull.h"
#include "dismantle/geometry/hulls_apart.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

using shapes::assembly_of;
using shapes::random_pose;
using shapes::random_vector;
using shapes::shift;
using shapes::Vec3;

Path path_of(const std::vector<Pose>& poses) {
  Path path;
  for (const auto& p : poses) path.push_back({p});
  return path;
}

/// Checks part 0, `moving`, along the poses, with part 1 fixed at the origin.
MotionCheck check(const Mesh& moving, const Mesh& fixed, const std::vector<Pose>& poses, double most = 0.01,
                  double overlap = 0) {
  std::vector<InitialOverlap> overlaps;
  if (overlap > 0) overlaps.push_back({0, 1, overlap});
  const Verifier verifier(assembly_of({moving, fixed}, overlaps), {most});
  return verifier.check_motion({0}, {{1, Pose{}}}, path_of(poses));
}

Pose turn(double angle, const Vec3& axis, const Vec3& about = Vec3::Zero()) {
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, axis));
  return {about - q * about, q};
}

const Mesh kCube = shapes::box({-.5, -.5, -.5}, {.5, .5, .5});

TEST(Verifier, FreeMotionIsAcceptedWithATinyBound) {
  const MotionCheck c = check(kCube, shapes::box({5, 5, 5}, {6, 6, 6}), {shift({0, 0, 0}), shift({0, 9, 0})});
  EXPECT_TRUE(c.valid);
  EXPECT_LE(c.max_penetration, 1e-4);
  EXPECT_FALSE(c.violation.has_value());
}

/// Groups of boxes, turned or not: the hulls are apart at the end of the path, and not slightly earlier.
TEST(Verifier, AWayEndsWhereTheHullsComeApart) {
  Rng rng(21);
  int found = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<Mesh> meshes;
    std::vector<PlacedPart> group, rest;
    const bool turned = trial % 2 == 0;
    for (PartId id = 0; id < 7; ++id) {
      const Vec3 lo = random_vector(rng, -2, 1);
      meshes.push_back(shapes::refine(shapes::box(lo, lo + random_vector(rng, 0.2, 1)), 1));
      (id < 3 ? group : rest).push_back({id, turned ? random_pose(rng, 0.5) : shift(random_vector(rng, -0.5, 0.5))});
    }
    const Verifier verifier(assembly_of(meshes), {0.01});
    std::vector<Aabb> boxes;
    for (const Mesh& mesh : meshes) boxes.push_back(mesh.box());
    const Vec3 d = trial % 3 == 0 ? Vec3(Vec3::Unit(trial % 9 / 3)) : Vec3(random_vector(rng, -1, 1).normalized());
    const auto apart_after = [&](double travel) {
      std::vector<PlacedPart> moved = group;
      for (auto& p : moved) p.pose.t += travel * d;
      return verifier.apart(moved, rest);
    };
    constexpr double kMost = 20;
    constexpr int kHalvings = 12;
    const auto hulls = [&](const std::vector<PlacedPart>& parts) {
      std::vector<geometry::PlacedHull> placed;
      for (const PlacedPart& p : parts)
        placed.push_back({&meshes[p.part], &boxes[p.part], &verifier.hull(p.part), p.pose});
      return placed;
    };
    const double travel = geometry::HullsApart(hulls(group), hulls(rest)).distance(d, kMost, kHalvings);
    EXPECT_TRUE(apart_after(travel));
    if (const double before = travel - 1.5 * kMost / (1 << kHalvings); before > 0) {
      EXPECT_FALSE(apart_after(before)) << travel;
      ++found;
    }
    // By all vertices: no plane across the path separates them earlier.
    double top = -1e9, bottom = 1e9;
    for (const auto& p : group)
      for (const auto& v : meshes[p.part].vertices) top = std::max(top, -d.dot(p.pose * v));
    for (const auto& p : rest)
      for (const auto& v : meshes[p.part].vertices) bottom = std::min(bottom, -d.dot(p.pose * v));
    EXPECT_LE(travel, std::max(0.0, top - bottom) + 2 * kMost / (1 << kHalvings));
  }
  EXPECT_GT(found, 40);
  const Aabb box = kCube.box();
  const std::vector<Vec3> corners = hull_corners(kCube.vertices);
  geometry::HullsApart alone({{&kCube, &box, &corners, Pose{}}}, {});
  EXPECT_LT(alone.distance(Vec3::UnitX(), 5, 10), 0.01) << "nothing is in the way";
}

TEST(Verifier, KissingSlideIsOneCheapSweep) {
  Rng rng(1);
  // A peg with no clearance at all in its pocket, noise of 1e-7 on the peg, turned at random.
  const Pose world = random_pose(rng, 2);
  Mesh peg = shapes::refine(shapes::box({-1, -1, -3}, {1, 1, 3}), 3);
  for (auto& v : peg.vertices) v += random_vector(rng, -1e-7, 1e-7);
  Mesh block = shapes::box({-2, -2, -3}, {2, 2, 3});
  shapes::append(block, shapes::box({-9, -9, -9}, {-8, -8, -8}));
  // A square tube around the peg.
  Mesh tube = shapes::tube(std::numbers::sqrt2, 3, -3, 3, 4, 1, std::numbers::pi / 4);
  const Vec3 travel = world.q * Vec3(0, 0, 10);
  const MotionCheck c = check(shapes::moved(peg, world), shapes::moved(tube, world), {Pose{}, shift(travel)});
  EXPECT_TRUE(c.valid);
  EXPECT_LE(c.max_penetration, 1e-4);
  EXPECT_LE(c.tests, 3 * (peg.triangles.size() + tube.triangles.size()));
  // The same with a hundred poses with small deviations.
  std::vector<Pose> poses;
  for (int i = 0; i <= 100; ++i) poses.push_back(shift(travel * i / 100 + random_vector(rng, -1e-5, 1e-5)));
  const MotionCheck many = check(shapes::moved(peg, world), shapes::moved(tube, world), poses);
  EXPECT_TRUE(many.valid);
  EXPECT_LE(many.max_penetration, 2e-4);
}

TEST(Verifier, SidewaysOutOfAFitIsRefusedWithAWitness) {
  const Mesh peg = shapes::tube(0, 1, -2, 2, 32, 4), sleeve = shapes::tube(1.005, 2, -2, 2, 32, 4);
  const MotionCheck c = check(peg, sleeve, {Pose{}, shift({0.03, 0, 0})});
  ASSERT_FALSE(c.valid);
  ASSERT_TRUE(c.violation.has_value());
  const Violation& v = *c.violation;
  EXPECT_FALSE(v.uncertain);
  EXPECT_GT(v.depth, 0.01);
  EXPECT_EQ(v.segment, 0u);
  // The witness can be replayed by an independent measurement.
  const Pose at = shift({0.03 * v.u, 0, 0});
  const Vec3 x = v.part == 0 ? at * v.point : at.inverse() * v.point;
  EXPECT_NEAR(TriangleBvh(v.part == 0 ? sleeve : peg).signed_distance(x), -v.depth, 1e-9);
}

TEST(Verifier, FirstContactOfMovingBoxesIsFoundWhereItMustBe) {
  Rng rng(2);
  for (int i = 0; i < 60; ++i) {
    const Pose world = random_pose(rng, 2);
    const double gap = rng.uniform(0.1, 2), reach = rng.uniform(0, 3);
    const Mesh a = shapes::moved(shapes::box({-1, -.3, -.4}, {0, .3, .4}), world);
    const Mesh b = shapes::moved(shapes::box({gap, -1, -1}, {gap + 2, 1, 1}), world);
    const double depth = reach - gap;  // at the end; the smaller box's face goes in
    const MotionCheck c = check(a, b, {Pose{}, shift(world.q * Vec3(reach, 0, 0))});
    if (depth < 0.004) {
      EXPECT_TRUE(c.valid) << depth;
    }
    if (depth > 0.01) {
      ASSERT_FALSE(c.valid) << depth;
      // No violation is possible before the face is 0.01 deep.
      EXPECT_GE(c.violation->u, (gap + 0.01) / reach - 1e-9);
    }
    if (c.valid) {
      EXPECT_GE(c.max_penetration, depth);
    }
  }
}

TEST(Verifier, TunnellingBetweenTwoPosesIsRefused) {
  const Mesh wall = shapes::box({2, -5, -5}, {2.03, 5, 5});
  const MotionCheck c = check(kCube, wall, {Pose{}, shift({4, 0, 0})});
  EXPECT_FALSE(c.valid);
  const MotionCheck thinner = check(kCube, shapes::box({2, -5, -5}, {2.003, 5, 5}), {Pose{}, shift({4, 0, 0})});
  EXPECT_FALSE(thinner.valid);
}

TEST(Verifier, PlateInAClosedBoxNeverGetsOut) {
  const Mesh plate = shapes::box({-1, -1, -.02}, {1, 1, .02});
  for (const double wall : {0.03, 0.003}) {
    const Mesh house = shapes::closed_box({-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}, wall);
    EXPECT_TRUE(check(plate, house, {Pose{}, shift({0, 0, 1})}).valid) << wall;
    for (const Vec3& travel : {Vec3(0, 0, 4), Vec3(4, 0, 0), Vec3(3, 3, 1)}) {
      EXPECT_FALSE(check(plate, house, {Pose{}, shift(travel)}).valid) << wall;
      std::vector<Pose> slowly;  // in steps that are shorter than the wall
      for (int i = 0; i <= 2000; ++i) slowly.push_back(shift(travel * i / 2000));
      EXPECT_FALSE(check(plate, house, slowly).valid) << wall;
    }
  }
}

TEST(Verifier, ThinSheetsDoNotPassThroughEachOther) {
  const auto sheet = [](double h) { return shapes::box({-2, -2, 0}, {2, 2, h}); };
  for (const double a : {0.003, 0.05})
    for (const double b : {0.003, 0.05}) {
      if (a == 0.05 && b == 0.05) continue;
      const Mesh lower = sheet(a), upper = shapes::moved(sheet(b), shift({0.3, 0.2, a}));  // lying flush on it
      EXPECT_FALSE(check(upper, lower, {Pose{}, shift({0, 0, -0.2})}).valid) << a << ' ' << b;
      EXPECT_TRUE(check(upper, lower, {Pose{}, shift({0, 0, 1})}).valid) << a << ' ' << b;
      EXPECT_TRUE(check(upper, lower, {Pose{}, shift({5, 0, 0})}).valid) << a << ' ' << b;
    }
  // Crosswise, edge on: a knife through a sheet.
  const Mesh knife = shapes::box({-1, -.0015, 0.01}, {1, .0015, 1});
  EXPECT_FALSE(check(knife, shapes::box({-2, -2, -.003}, {2, 2, 0}), {Pose{}, shift({0, 0, -2})}).valid);
  // Finely cut sheets whose vertices are far from each other's.
  const Mesh fine = shapes::refine(sheet(0.003), 4);
  EXPECT_FALSE(check(shapes::moved(fine, shift({0.01, 0.02, 0.003})), fine, {Pose{}, shift({0, 0, -0.1})}).valid);
}

TEST(Verifier, InitialOverlapIsAllowedButNotMore) {
  // A bolt that is too thick for its hole by 0.05 all around.
  const Mesh bolt = shapes::tube(0, 1.05, -2, 2, 48, 4), plate = shapes::tube(1, 3, -1, 1, 48, 2);
  const double overlap = penetration_depth(bolt, {}, plate, {}, 1e-4);
  EXPECT_NEAR(overlap, 0.05, 2e-4);
  const std::vector<Pose> out = {Pose{}, shift({0, 0, 5})};
  EXPECT_TRUE(check(bolt, plate, out, 0.01, overlap).valid);
  EXPECT_FALSE(check(bolt, plate, {Pose{}, shift({0.02, 0, 0})}, 0.01, overlap).valid);
  EXPECT_FALSE(check(bolt, plate, out).valid);  // the allowance belongs to the pair
  // ... and does not extend to another pair: the same bolt past a second plate that it does not overlap.
  const Mesh second = shapes::moved(shapes::tube(1.05, 3, -0.5, 0.5, 48, 1), shift({0.03, 0, 2.6}));
  const Verifier verifier(assembly_of({bolt, plate, second}, {{0, 1, overlap}}), {0.01});
  const MotionCheck c = verifier.check_motion({0}, {{1, Pose{}}, {2, Pose{}}}, path_of(out));
  ASSERT_FALSE(c.valid);
  EXPECT_EQ(std::max(c.violation->part, c.violation->other), 2u);
}

/// A plate with a thin lip, moulded into a comb of walls: half a wall deep in each of them.
TEST(Verifier, BuriedPlateSlidesOutAlongItsWalls) {
  Rng rng(3);
  const double width = rng.uniform(0.10, 0.12), gap = rng.uniform(0.12, 0.2), thick = rng.uniform(0.02, 0.04);
  const double left = -0.5 * gap, right = 5 * (width + gap) + left;
  Mesh walls;
  for (int k = 0; k < 5; ++k)
    shapes::append(walls, shapes::box({k * (width + gap), 0, -0.2}, {k * (width + gap) + width, 1.2, 0.3}));
  Mesh plate = shapes::box({left, 0.05, -0.5 * thick}, {right, 1.25, 0.5 * thick});
  shapes::append(plate, shapes::box({left, 0.02, -0.5 * thick}, {right, 0.049, 0.5 * thick + 0.01}));
  const double depth = penetration_depth(plate, Pose{}, walls, Pose{}, 1e-6);
  EXPECT_NEAR(depth, 0.5 * width, 1e-5);
  const MotionCheck c = check(plate, walls, {Pose{}, shift({0.003, 2, 0.002})}, 0.01, depth);
  EXPECT_TRUE(c.valid);
  EXPECT_LE(c.max_penetration, 0.01);  // above so deep an overlap no lower bound is worth its proof
  EXPECT_LT(c.tests, 900'000u) << "pieces beside a ridge are verified whole: without that it takes 1.2 million";
}

TEST(Verifier, BuriedPlateDoesNotGoIntoAThickerWall) {
  Mesh walls = shapes::box({0, 0, -0.2}, {0.1, 0.3, 0.3});
  shapes::append(walls, shapes::box({0.3, 0, -0.2}, {0.5, 0.3, 0.3}));
  const Mesh plate = shapes::box({-0.06, 0.05, -0.015}, {0.2, 0.35, 0.015});
  const MotionCheck c = check(plate, walls, {Pose{}, shift({0.25, 0, 0})}, 0.01, 0.05);
  ASSERT_TRUE(c.violation);
  EXPECT_FALSE(c.violation->uncertain);
  EXPECT_GT(c.violation->depth, 0.05 + 0.0075) << "a quarter of the plate's thickness may be added";
}

TEST(Verifier, BarThatHitsOnlyInMidTurnIsRefused) {
  const Mesh bar = shapes::box({0, -.1, -.1}, {4, .1, .1});
  const double angle = 0.9 * std::numbers::pi;
  // Between start and end, just within the circle of the bar's tip.
  for (const auto& [distance, ok] : {std::pair{3.98, false}, std::pair{4.02, true}}) {
    const Vec3 at = turn(angle / 2, Vec3::UnitZ()) * Vec3(distance, 0, 0);
    const Mesh post = shapes::moved(shapes::box({0, -.05, -1}, {.1, .05, 1}),
                                    {at, Eigen::Quaterniond(Eigen::AngleAxisd(angle / 2, Vec3::UnitZ()))});
    EXPECT_EQ(check(bar, post, {Pose{}, turn(angle, Vec3::UnitZ())}).valid, ok) << distance;
  }
}

TEST(Verifier, DiscTurnsInItsHousing) {
  // A round disc of 64 corners in a housing of the same outline: the corners scrape by the sagitta of a facet.
  const double r = 2, sagitta = r * (1 - std::cos(std::numbers::pi / 64));
  const Mesh disc = shapes::tube(0, r, -.2, .2, 64), housing = shapes::tube(r, 3, -.4, .4, 64);
  const MotionCheck c = check(disc, housing, {Pose{}, turn(2.0, Vec3::UnitZ())}, 0.01);
  EXPECT_TRUE(c.valid);
  EXPECT_GE(c.max_penetration, sagitta * 0.99);
  EXPECT_FALSE(check(disc, housing, {Pose{}, turn(2.0, Vec3::UnitZ())}, 0.5 * sagitta).valid);
}

TEST(Verifier, ScrewMotionFollowsAThreadLikeGroove) {
  // A pin on a helix through a helical channel made of blocks left and right of it.
  const double lead = 1.5;
  const auto along = [&](double angle) {
    Pose p = turn(angle, Vec3::UnitZ());
    p.t.z() += lead * angle / (2 * std::numbers::pi);
    return p;
  };
  const Mesh pin = shapes::box({2, -.1, -.1}, {2.5, .1, .1});
  Mesh channel;
  for (int i = -2; i < 60; ++i)
    for (const double side : {-1.0, 1.0})
      shapes::append(channel,
                     shapes::moved(shapes::box({1.9, -.15, side > 0 ? .16 : -.36}, {2.6, .15, side > 0 ? .36 : -.16}),
                                   along(0.1 * i)));
  std::vector<Pose> poses;
  for (int i = 0; i <= 20; ++i) poses.push_back(along(0.25 * i));
  EXPECT_TRUE(check(pin, channel, poses).valid);
  for (auto& p : poses) p.t.z() *= 1.2;  // wrong lead
  EXPECT_FALSE(check(pin, channel, poses).valid);
}

TEST(Verifier, MovingPartsAreJudgedAgainstEachOther) {
  const Mesh left = shapes::moved(kCube, shift({-.5, 0, 0})), right = shapes::moved(kCube, shift({.5, 0, 0}));
  const Verifier verifier(assembly_of({left, right, shapes::box({-1, -1, -2}, {1, 1, -.5})}), {0.01});
  const std::vector<PlacedPart> base = {{2, Pose{}}};
  const Path together = {{Pose{}, Pose{}}, {shift({0, 0, 3}), shift({0, 0, 3})}};
  EXPECT_TRUE(verifier.check_motion({0, 1}, base, together).valid);
  // The two overlap, but do not move relative to each other: no pair to check. Also while they turn.
  const Verifier overlapping(assembly_of({left, kCube, shapes::box({-1, -1, -2}, {1, 1, -.5})}), {0.01});
  EXPECT_TRUE(overlapping.check_motion({0, 1}, base, together).valid);
  const Pose lift = shift({0, 0, 3}), twist = turn(1.0, Vec3::UnitY()) * lift;
  EXPECT_TRUE(overlapping.check_motion({0, 1}, base, {{Pose{}, Pose{}}, {lift, lift}, {twist, twist}}).valid);
  // Different speeds are valid, passing through each other is not.
  EXPECT_TRUE(verifier.check_motion({0, 1}, base, {{Pose{}, Pose{}}, {shift({0, 0, 3}), shift({0, 0, 1})}}).valid);
  const MotionCheck c =
      verifier.check_motion({0, 1}, base, {{Pose{}, Pose{}}, {shift({.2, 0, 3}), shift({-.2, 0, 3})}});
  ASSERT_FALSE(c.valid);
  EXPECT_EQ(c.violation->part + c.violation->other, 1u);
  // Two arms that cross only on the way, both turning.
  const Mesh arm = shapes::box({0, -.1, -.1}, {3, .1, .1});
  const Verifier arms(assembly_of({arm, shapes::moved(arm, {Vec3(5, 0, 0), turn(std::numbers::pi, Vec3::UnitZ()).q})}),
                      {0.01});
  const Pose a0 = turn(1, Vec3::UnitZ()), a1 = turn(-1, Vec3::UnitZ());
  const Pose b0 = turn(1, Vec3::UnitZ(), {5, 0, 0}), b1 = turn(-1, Vec3::UnitZ(), {5, 0, 0});
  EXPECT_FALSE(arms.check_motion({0, 1}, {}, {{a0, b0}, {a1, b1}}).valid);
}

TEST(Verifier, AgreesWithDenseSamplingOnRandomMotions) {
  Rng rng(3);
  int accepted = 0, refused = 0;
  for (int i = 0; i < 60; ++i) {
    const Mesh a = shapes::box({-.6, -.4, -.3}, {.6, .4, .3}), b = shapes::tube(0.8, 1.6, -.5, .5, 12);
    Pose from = random_pose(rng, 0), to = random_pose(rng, 0);
    from.t = random_vector(rng, -1, 1).normalized() * rng.uniform(2.5, 3.0);
    to.t = random_vector(rng, -1, 1).normalized() * rng.uniform(2.5, 3.0);
    double deepest = 0;
    for (int k = 0; k <= 400 && deepest < 0.02; ++k)
      deepest = std::max(deepest, penetration_depth(a, screw_interpolate(from, to, k / 400.0), b, {}, 1e-3));
    const MotionCheck c = check(a, b, {from, to});
    if (deepest > 0.0101) {
      EXPECT_FALSE(c.valid) << i;
    }
    if (deepest == 0) {
      EXPECT_TRUE(c.valid) << i << (c.violation ? c.violation->depth : 0);
    }
    (c.valid ? accepted : refused) += 1;
  }
  EXPECT_GT(accepted, 5);
  EXPECT_GT(refused, 5);
}

TEST(Verifier, BoundIsOnTheLadderAndCertified) {
  // A slab pushed 0.0015 into another and then along it.
  const Mesh slab = shapes::box({-1, -1, 0}, {1, 1, 1}), floor = shapes::box({-9, -9, -2}, {9, 9, 0});
  const MotionCheck c = check(slab, floor, {Pose{}, shift({1, 0, -0.0015}), shift({4, 0, -0.0015}), shift({4, 0, 2})});
  ASSERT_TRUE(c.valid);
  EXPECT_GE(c.max_penetration, 0.0015);
  EXPECT_LE(c.max_penetration, 0.005);
  EXPECT_FALSE(check(slab, floor, {Pose{}, shift({1, 0, -0.0015})}, 0.001).valid);
  EXPECT_FALSE(check(slab, floor, {Pose{}, shift({1, 0, -0.011})}).valid);
}

TEST(Verifier, SameQuestionSameAnswerOnAnyThread) {
  const Mesh peg = shapes::tube(0, 1, -2, 2, 32, 4), sleeve = shapes::tube(1.001, 2, -2, 2, 40, 4);
  const Verifier verifier(assembly_of({peg, sleeve}), {0.01});
  Rng rng(4);
  std::vector<Pose> poses;
  for (int i = 0; i <= 50; ++i)
    poses.push_back({Vec3(0, 0, 0.1 * i) + random_vector(rng, -3e-3, 3e-3), turn(0.05 * i, Vec3::UnitZ()).q});
  const Path path = path_of(poses);
  const MotionCheck once = verifier.check_motion({0}, {{1, Pose{}}}, path);
  std::vector<MotionCheck> answers(4);
  std::vector<std::thread> threads;
  for (auto& a : answers) threads.emplace_back([&] { a = verifier.check_motion({0}, {{1, Pose{}}}, path); });
  for (auto& t : threads) t.join();
  for (const auto& a : answers) {
    EXPECT_EQ(a.valid, once.valid);
    EXPECT_EQ(a.max_penetration, once.max_penetration);
    EXPECT_EQ(a.tests, once.tests);
  }
}

TEST(Verifier, ApartMeansHullsApart) {
  const Mesh ring = shapes::tube(1, 1.2, -.1, .1, 24);
  const Verifier verifier(assembly_of({ring, shapes::tube(0, .5, -.1, .1, 24), kCube}), {0.01});
  EXPECT_FALSE(verifier.apart({{1, Pose{}}}, {{0, Pose{}}}));  // free, but within the hull
  EXPECT_FALSE(verifier.apart({{1, shift({0, 0, .2})}}, {{0, Pose{}}}));
  EXPECT_TRUE(verifier.apart({{1, shift({0, 0, .201})}}, {{0, Pose{}}}));
  EXPECT_TRUE(verifier.apart({{1, Pose{}}}, {}));
  // Two parts left and right of a third: their common hull contains it.
  EXPECT_FALSE(verifier.apart({{2, Pose{}}}, {{0, shift({3, 0, 0})}, {1, shift({-3, 0, 0})}}));
  EXPECT_TRUE(verifier.apart({{2, shift({0, 0, 2})}}, {{0, shift({3, 0, 0})}, {1, shift({-3, 0, 0})}}));
}

TEST(Verifier, BadQuestionsThrow) {
  EXPECT_THROW(Verifier(assembly_of({kCube, kCube}), {0}), std::invalid_argument);
  const Verifier verifier(assembly_of({kCube, shapes::moved(kCube, shift({3, 0, 0}))}), {0.01});
  EXPECT_THROW(verifier.check_motion({0}, {}, path_of({Pose{}})), std::invalid_argument);
  EXPECT_THROW(verifier.check_motion({0, 1}, {}, path_of({Pose{}, Pose{}})), std::invalid_argument);
  Pose broken;
  broken.t.x() = std::nan("");
  EXPECT_THROW(verifier.check_motion({0}, {}, path_of({Pose{}, broken})), std::invalid_argument);
}

}  // namespace
}  // namespace dismantle
