// Rooms with windows: a part counts as enclosed when the window is too small for its ball, and never when it fits
// through.
#include "enclosed_ball/enclosed_ball.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "prover_rig.h"

namespace dismantle::immobility {
namespace {

using shapes::assembly_of;
using shapes::box;
using shapes::random_pose;
using shapes::Vec3;

/// A room of 2 x 2 x 2 about the origin with walls of 0.2 and a square window of the given width in its roof.
Mesh room(double window) {
  const double w = 0.5 * window;
  Mesh m = box({-1.2, -1.2, -1.2}, {1.2, 1.2, -1});
  shapes::append(m, box({-1.2, -1.2, -1.1}, {-1, 1.2, 1.1}));
  shapes::append(m, box({1, -1.2, -1.1}, {1.2, 1.2, 1.1}));
  shapes::append(m, box({-1.1, -1.2, -1.1}, {1.1, -1, 1.1}));
  shapes::append(m, box({-1.1, 1, -1.1}, {1.1, 1.2, 1.1}));
  shapes::append(m, box({-1.2, -1.2, 1}, {-w, 1.2, 1.2}));
  shapes::append(m, box({w, -1.2, 1}, {1.2, 1.2, 1.2}));
  shapes::append(m, box({-1, -1.2, 1.05}, {1, -w, 1.15}));
  shapes::append(m, box({-1, w, 1.05}, {1, 1.2, 1.15}));
  return m;
}

/// Its certificate is accepted, and none with a larger ball, another pose or a missing number.
std::optional<Certificate> enclosed(const ProverRig& rig, const std::vector<PlacedPart>& moving,
                                    const std::vector<PlacedPart>& fixed) {
  auto found = EnclosedBall{}.prove(rig.query(moving, fixed), {});
  if (!found) return found;
  EXPECT_EQ(rig.objection(EnclosedBall{}, "enclosed_ball", *found), "");
  Certificate forged = *found;
  forged.numbers.at("radius").front() *= 1.01;
  EXPECT_NE(rig.objection(EnclosedBall{}, "enclosed_ball", forged), "") << "it holds no such ball";
  forged = *found;
  forged.poses.front().t += Vec3(0, 0, 10);
  EXPECT_NE(rig.objection(EnclosedBall{}, "enclosed_ball", forged), "") << "it is outside of the room";
  forged = *found;
  forged.numbers.erase("center");
  EXPECT_NE(rig.objection(EnclosedBall{}, "enclosed_ball", forged), "");
  return found;
}

Mesh cube(double edge, const Vec3& at) { return box(at - Vec3::Constant(0.5 * edge), at + Vec3::Constant(0.5 * edge)); }

TEST(EnclosedBall, BehindAWindowThatIsTooSmallHoweverItLies) {
  Rng rng(1);
  for (int i = 0; i < 6; ++i) {
    const double edge = rng.uniform(0.5, 1.2), window = edge * rng.uniform(0.2, 0.85);
    const Vec3 at = 0.5 * (2 - 1.01 * edge) * Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    const Pose turned = random_pose(rng, 2);
    const ProverRig rig(assembly_of({shapes::moved(cube(edge, at), turned), shapes::moved(room(window), turned)}),
                        0.01);
    const auto found = enclosed(rig, {{0, Pose{}}}, {{1, Pose{}}});
    ASSERT_TRUE(found) << edge << " behind " << window;
    EXPECT_EQ(found->parts, (std::vector<PartId>{0, 1}));
    EXPECT_GE(found->numbers.at("radius").front(), 0.95 * 0.5 * edge);
    EXPECT_LE(found->numbers.at("radius").front(), 0.5 * edge + 1e-9);
    const auto back = enclosed(rig, {{1, Pose{}}}, {{0, Pose{}}});  // the room cannot leave the cube, either
    ASSERT_TRUE(back);
    EXPECT_EQ(back->parts.front(), 0u);
  }
}

TEST(EnclosedBall, NeverBehindAWindowThatItFitsThrough) {
  Rng rng(2);
  for (int i = 0; i < 6; ++i) {
    const double edge = rng.uniform(0.5, 0.9), window = edge * rng.uniform(1.0, 1.3);
    const Pose turned = random_pose(rng, 2);
    const ProverRig rig(
        assembly_of({shapes::moved(cube(edge, Vec3::Zero()), turned), shapes::moved(room(window), turned)}), 0.01);
    EXPECT_FALSE(enclosed(rig, {{0, Pose{}}}, {{1, Pose{}}}));
    EXPECT_FALSE(enclosed(rig, {{1, Pose{}}}, {{0, Pose{}}}));
  }
}

TEST(EnclosedBall, WhatMayBePenetratedCountsAsOpen) {
  for (const double allowed : {0.01, 0.04, 0.1}) {
    // The ball of radius 0.4 passes as long as no more than `allowed` is missing on either side.
    for (const double missing : {0.9 * allowed, 1.6 * allowed + 0.1}) {
      const ProverRig rig(assembly_of({cube(0.8, Vec3::Zero()), room(0.8 - 2 * missing)}), allowed);
      EXPECT_EQ(enclosed(rig, {{0, Pose{}}}, {{1, Pose{}}}).has_value(), missing > allowed)
          << allowed << " " << missing;
    }
  }
}

TEST(EnclosedBall, OnlyTheRoomAsItIsNowCounts) {
  // The roof is another part: with it there is no way out, without it there is.
  Mesh walls = box({-1.2, -1.2, -1.2}, {1.2, 1.2, -1});
  for (const auto& [lo, hi] :
       {std::pair(Vec3(-1.2, -1.2, -1), Vec3(-1, 1.2, 1)), std::pair(Vec3(1, -1.2, -1), Vec3(1.2, 1.2, 1)),
        std::pair(Vec3(-1, -1.2, -1), Vec3(1, -1, 1)), std::pair(Vec3(-1, 1, -1), Vec3(1, 1.2, 1))})
    shapes::append(walls, box(lo, hi));
  const ProverRig rig(assembly_of({cube(1, Vec3::Zero()), walls, box({-1.2, -1.2, 1}, {1.2, 1.2, 1.2})}), 0.01);
  const auto found = enclosed(rig, {{0, Pose{}}}, {{1, Pose{}}, {2, Pose{}}});
  ASSERT_TRUE(found);
  std::vector<PartId> around(found->parts.begin() + 1, found->parts.end());
  std::sort(around.begin(), around.end());
  EXPECT_EQ(found->parts.front(), 0u);
  EXPECT_EQ(around, (std::vector<PartId>{1, 2}));
  EXPECT_FALSE(enclosed(rig, {{0, Pose{}}}, {{1, Pose{}}}));
  EXPECT_FALSE(enclosed(rig, {{0, Pose{}}}, {{1, Pose{}}, {2, shapes::shift({0, 0, 3})}}));
  EXPECT_FALSE(enclosed(rig, {{2, Pose{}}}, {{0, Pose{}}, {1, Pose{}}}));
}

}  // namespace
}  // namespace dismantle::immobility
