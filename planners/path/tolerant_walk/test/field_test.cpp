// Distance fields and state validity, compared with the original triangles.
#include <gtest/gtest.h>

#include <thread>

#include "dismantle/tolerant_walk/distance_field.h"
#include "dismantle/tolerant_walk/validity_checker.h"
#include "dismantle/verification/verifier.h"
#include "solids.h"

namespace dismantle::tolerant_walk {
namespace {

using Eigen::Vector3d;
using path::test::assembly_of;
using path::test::block;
using path::test::boxes;
using path::test::moved;
using path::test::random_pose;

TEST(DistanceField, IsWithinACellOfTheDistance) {
  Rng rng(3);
  for (int k = 0; k < 10; ++k) {
    const Vector3d half(rng.uniform(0.05, 1), rng.uniform(0.05, 1), rng.uniform(0.05, 1));
    const auto mesh = std::make_shared<const Mesh>(
        moved(boxes({block(-half.x(), -half.y(), -half.z(), half.x(), half.y(), half.z())}), random_pose(rng, 1)));
    const double cell = rng.uniform(0.01, 0.03);
    DistanceField field(mesh, {cell});
    const TriangleBvh exact(*mesh);
    for (int i = 0; i < 500; ++i) {
      const Vector3d p = mesh->box().center() +
                         1.2 * half.norm() * Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
      const double d = exact.signed_distance(p);
      if (std::abs(d) < 0.07) {
        EXPECT_NEAR(field.at(p), d, cell) << k;
      } else {  // far away, only a bound of the distance is needed
        EXPECT_LE(field.at(p), d + 8 * cell);
        EXPECT_GE(std::abs(field.at(p)), 0.07 - cell);
        EXPECT_EQ(field.at(p) < 0, d < 0);
      }
    }
  }
}

/// Values depend neither on earlier queries nor on queries of other threads.
TEST(DistanceField, IsTheSameForSeveralThreads) {
  Rng rng(4);
  for (int k = 0; k < 5; ++k) {
    const auto mesh = std::make_shared<const Mesh>(moved(
        boxes({block(-0.6, -0.4, -0.1, 0.6, 0.4, 0.1), block(0.7, -0.2, -0.3, 0.75, 0.2, 0.3)}), random_pose(rng, 1)));
    std::vector<Vector3d> points;
    for (int i = 0; i < 3000; ++i)
      points.push_back(mesh->box().center() + Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)));
    DistanceField alone(mesh, {0.02}), shared(mesh, {0.02});
    std::vector<double> expected;
    for (const auto& p : points) expected.push_back(alone.at(p));
    std::vector<std::vector<double>> said(3);
    {
      std::vector<std::jthread> threads;
      for (std::size_t t = 0; t < said.size(); ++t)
        threads.emplace_back([&, t] {
          said[t].resize(points.size());
          for (std::size_t i = 0; i < points.size(); ++i) {
            const std::size_t at = t == 1 ? points.size() - 1 - i : i;
            said[t][at] = shared.at(points[at]);
          }
        });
    }
    for (const auto& one : said) EXPECT_EQ(one, expected);
    EXPECT_EQ(shared.bytes(), alone.bytes());
  }
}

/// A plate on a block is moved down into it or rotated. Poses clearly within the tolerance are valid and poses clearly
/// beyond it are not, for any orientation of the two and any initial overlap.
TEST(ValidityChecker, AgreesWithTheDepthOfThePair) {
  Rng rng(5);
  int in = 0, beyond = 0;
  for (int k = 0; k < 6; ++k) {
    const Pose turned = random_pose(rng, 1);
    const double sunk = k % 3 == 0 ? rng.uniform(0.01, 0.05) : 0;
    const Mesh plate = moved(boxes({block(-1, -0.7, -sunk, 1, 0.7, 0.4 - sunk)}), turned),
               ground = moved(boxes({block(-1.5, -1.5, -1, 1.5, 1.5, 0)}), turned);
    Assembly assembly = assembly_of({plate, ground});
    const double overlap = penetration_depth(plate, Pose{}, ground, Pose{}, 1e-4);
    if (overlap > 0) assembly.overlaps.push_back({0, 1, overlap});
    const double most = 0.01;
    GeometryCache cache;
    ValidityChecker checker(assembly, {{{0, Pose{}}}, {{1, Pose{}}}}, most, cache);
    for (int i = 0; i < 60; ++i) {
      const Eigen::Quaterniond q(Eigen::AngleAxisd(
          rng.uniform(-0.02, 0.02), turned.q * Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized()));
      Pose at{turned.q * Vector3d(rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3), rng.uniform(-0.03, 0.03)), q};
      at.t += turned.t - q * turned.t;
      const double depth = penetration_depth(plate, at, ground, Pose{}, 1e-4);
      const bool allowed = checker.is_valid(at);
      if (depth < overlap + 0.5 * most) {
        EXPECT_TRUE(allowed) << depth << ' ' << overlap;
        ++in;
      }
      if (depth > overlap + 1.5 * most) {
        EXPECT_FALSE(allowed) << depth << ' ' << overlap;
        EXPECT_EQ(checker.obstacle(), PartId{1});
        ++beyond;
      }
    }
  }
  EXPECT_GT(in, 50);
  EXPECT_GT(beyond, 50);
}

TEST(ValidityChecker, SeesAWallBetweenTheSamplesOfTheOther) {
  // A wall of 0.06 in the middle of a block. Only corners and faces of both are sampled, and no such point is deep.
  Rng rng(7);
  for (int k = 0; k < 5; ++k) {
    const Pose turned = random_pose(rng, 1);
    const Assembly assembly =
        assembly_of({boxes({block(1, -1, -1, 3, 1, 1)}), boxes({block(0, -2, -2, 0.06, 2, 2)})}, turned);
    GeometryCache cache;
    ValidityChecker checker(assembly, {{{0, Pose{}}}, {{1, Pose{}}}}, 0.01, cache);
    for (double x = -0.2; x > -2.9; x -= 0.1) {
      const bool through = x < -0.95 && x > -2.98;
      EXPECT_EQ(checker.is_valid({turned.q * Vector3d(x, 0, 0), Eigen::Quaterniond::Identity()}), !through) << x;
    }
  }
}

/// Cached objects give the same results as new ones, whatever was computed before, even if the cache has no room.
/// Parts with the same mesh share a field.
TEST(GeometryCache, ChangesNoAnswer) {
  Rng rng(12);
  const auto plate = std::make_shared<Mesh>(boxes({block(-0.5, -0.4, -0.02, 0.5, 0.4, 0.2)})),
             ground = std::make_shared<Mesh>(boxes({block(-1, -1, -1, 1, 1, 0), block(-1, 0.5, 0, 1, 1, 1)}));
  Assembly assembly = assembly_of({*plate, *ground, *plate});
  assembly.parts[0].mesh = assembly.parts[2].mesh = plate;
  assembly.parts[1].mesh = ground;
  assembly.overlaps.push_back({0, 1, 0.02});
  GeometryCache kept, no_room(0);
  int allowed = 0, all = 0;
  for (int search = 0; search < 6; ++search) {
    const PartId moving = search % 2 == 0 ? 0 : 2;
    const Pose start = search < 4 ? Pose{} : random_pose(rng, 0.1);
    const Scene scene{{{moving, start}}, {{1, Pose{}}}};
    GeometryCache fresh;
    ValidityChecker uncached(assembly, scene, 0.01, fresh);
    ValidityChecker known(assembly, scene, 0.01, kept), poor(assembly, scene, 0.01, no_room);
    for (int i = 0; i < 300; ++i) {
      if (i == 200)
        for (auto* checker : {&uncached, &known, &poor})
          checker->add_contact_sample(moving, 1, Vector3d(0.5, 0.4, -0.02), Pose{});
      const Pose at{Vector3d(rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), rng.uniform(-0.03, 0.05)),
                    Eigen::Quaterniond(Eigen::AngleAxisd(rng.uniform(-0.05, 0.05), Vector3d::UnitX()))};
      const bool is = uncached.is_valid(at);
      EXPECT_EQ(known.is_valid(at), is);
      EXPECT_EQ(poor.is_valid(at), is);
      allowed += is;
      ++all;
    }
  }
  EXPECT_GT(allowed, all / 20);
  EXPECT_LT(allowed, all - all / 20);
  EXPECT_EQ(kept.field(plate, {}), kept.field(assembly.parts[2].mesh, {}));
  const std::size_t before = kept.bytes();
  kept.make_room();
  EXPECT_EQ(kept.bytes(), before);
  no_room.make_room();
  EXPECT_EQ(no_room.bytes(), 0U);
}

/// Concurrent searches, with room for everything or for nothing.
TEST(GeometryCache, ChangesNoAnswerOfSeveralThreads) {
  Rng rng(13);
  Assembly assembly = assembly_of({boxes({block(-0.5, -0.4, -0.02, 0.5, 0.4, 0.2)}),
                                   boxes({block(-1, -1, -1, 1, 1, 0), block(-1, 0.5, 0, 1, 1, 1)})});
  assembly.overlaps.push_back({0, 1, 0.02});
  std::vector<Pose> poses;
  for (int i = 0; i < 400; ++i)
    poses.push_back({Vector3d(rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), rng.uniform(-0.03, 0.05)),
                     Eigen::Quaterniond(Eigen::AngleAxisd(rng.uniform(-0.05, 0.05), Vector3d::UnitX()))});
  for (const bool room : {true, false}) {
    GeometryCache cache(room ? std::size_t{1} << 30 : 0);
    std::vector<std::vector<char>> said(4);
    {
      std::vector<std::jthread> threads;
      for (std::size_t t = 0; t < said.size(); ++t)
        threads.emplace_back([&, t] {
          for (int search = 0; search < 3; ++search) {
            const PartId moving = t % 2 == 0 ? 0 : 1;
            const Scene scene{{{moving, Pose{}}}, {{1 - moving, Pose{}}}};
            ValidityChecker checker(assembly, scene, 0.01, cache);
            for (const Pose& at : poses) said[t].push_back(checker.is_valid(at));
          }
        });
    }
    EXPECT_EQ(said[0], said[2]);
    EXPECT_EQ(said[1], said[3]);
    GeometryCache fresh;
    ValidityChecker checker(assembly, {{{0, Pose{}}}, {{1, Pose{}}}}, 0.01, fresh);
    for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_EQ(said[0][i], checker.is_valid(poses[i]));
  }
}

TEST(ValidityChecker, AddsARefusedPlace) {
  const Assembly assembly = assembly_of({boxes({block(-1, -1, 0, 1, 1, 1)}), boxes({block(-2, -2, -1, 2, 2, 0)})});
  GeometryCache cache;
  ValidityChecker checker(assembly, {{{0, Pose{}}}, {{1, Pose{}}}}, 0.01, cache);
  const Pose sunk{Vector3d(0, 0, -0.007), Eigen::Quaterniond::Identity()};
  EXPECT_TRUE(checker.is_valid(sunk));
  checker.add_contact_sample(0, 1, Vector3d(0.3, 0.4, 0), sunk);
  EXPECT_FALSE(checker.is_valid(sunk));
  EXPECT_TRUE(checker.is_valid({Vector3d(0, 0, -0.003), Eigen::Quaterniond::Identity()}));
  // From now on half of the refused depth is allowed.
  checker.add_contact_sample(0, 1, Vector3d(0.3, 0.4, 0), {Vector3d(0, 0, -0.004), Eigen::Quaterniond::Identity()});
  EXPECT_FALSE(checker.is_valid({Vector3d(0, 0, -0.003), Eigen::Quaterniond::Identity()}));
  EXPECT_TRUE(checker.is_valid({Vector3d(0, 0, -0.001), Eigen::Quaterniond::Identity()}));
  EXPECT_TRUE(checker.is_valid(Pose{}));
}

}  // namespace
}  // namespace dismantle::tolerant_walk
