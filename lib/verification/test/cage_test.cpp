// Two parts are called caged only when no motion within the limits parts them, wherever the assembly stands.
#include <gtest/gtest.h>

#include <numbers>

#include "dismantle/executor.h"
#include "dismantle/testing/held_shapes.h"
#include "dismantle/verification/explanations.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {
namespace {

using shapes::assembly_of;
using shapes::can;
using shapes::crank;
using shapes::moved;
using shapes::random_pose;
using shapes::Vec3;
using std::numbers::pi;

constexpr double kAllowed = 0.01;

std::optional<Cage> look(const Mesh& a, const Mesh& b, Rng& rng) {
  const Pose turned = random_pose(rng, 2);
  const Assembly assembly = assembly_of({moved(a, turned), moved(b, turned)});
  const Verifier verifier(assembly, {kAllowed});
  const auto cage = verifier.caged(0, 1);
  EXPECT_EQ(cage.has_value(), verifier.caged(1, 0).has_value());
  RunContext helped;
  helped.executor = std::make_shared<Executor>(3);
  const auto same = Verifier(assembly, {kAllowed}).caged(0, 1, helped);
  EXPECT_EQ(cage.has_value(), same.has_value());
  if (cage && same) {
    EXPECT_EQ(describe(*cage, assembly), describe(*same, assembly)) << "whoever helps";
  }
  RunContext stopped;
  stopped.cancel.cancel();
  const Verifier later(assembly, {kAllowed});
  EXPECT_FALSE(later.caged(0, 1, stopped));
  EXPECT_EQ(later.caged(0, 1).has_value(), cage.has_value()) << "what was stopped says nothing";
  return cage;
}

bool comes_out(const Mesh& part, const Mesh& of, const Vec3& by) {
  const Verifier verifier(assembly_of({part, of}), {kAllowed});
  return verifier.check_motion({0}, {{1, Pose{}}}, {{Pose{}}, {shapes::shift(by)}}).valid;
}

/// Somewhere in a can whose cavity is 1 wide and 0.6 high.
Mesh ring(double radius, Rng& rng) {
  const Pose at{0.02 * Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)),
                Eigen::Quaterniond(Eigen::AngleAxisd(rng.uniform(-0.05, 0.05), Vec3::UnitX()))};
  return moved(shapes::tube(0.5 * radius, radius, -0.1, 0.1, 48), at);
}

TEST(Caged, ARingInACanWithOpeningsThatAreTooSmall) {
  Rng rng(1);
  for (int i = 0; i < 12; ++i) {
    const double radius = rng.uniform(0.6, 0.9);
    const double below = radius * rng.uniform(0.1, 0.75), above = radius * rng.uniform(0.1, 0.75);
    const auto cage = look(ring(radius, rng), can(1, 0.6, below, above), rng);
    ASSERT_TRUE(cage) << radius << " behind " << below << " and " << above;
    EXPECT_EQ(cage->kind, Cage::Kind::ring);
    EXPECT_EQ(cage->inside, 0u);
    EXPECT_EQ(cage->other, 1u);
    EXPECT_LE(cage->size, 2 * radius - 2 * kAllowed);
    EXPECT_GE(cage->opening, 2 * std::max(below, above) * 0.99);
    EXPECT_LT(cage->opening, cage->size);
  }
}

TEST(Caged, NotWhereTheRingFitsThroughAnOpeningWithinWhatIsAllowed) {
  Rng rng(2);
  for (int i = 0; i < 5; ++i) {
    const double radius = rng.uniform(0.6, 0.9), opening = radius + rng.uniform(-0.9 * kAllowed, 0.08);
    EXPECT_FALSE(look(ring(radius, rng), can(1, 0.6, 0.2, opening), rng)) << radius << " behind " << opening;
    const Mesh straight = shapes::tube(0.5 * radius, radius, -0.1, 0.1, 48);
    if (opening > radius + kAllowed) {
      EXPECT_TRUE(comes_out(straight, can(1, 0.6, 0.2, opening), {0, 0, 3}));
    }
  }
}

TEST(Caged, NotInACanThatIsOpenAtItsSide) {
  Rng rng(3);
  for (int i = 0; i < 5; ++i) {
    const double radius = rng.uniform(0.5, 0.8), share = rng.uniform(0.5, 0.95);
    EXPECT_FALSE(look(ring(radius, rng), can(1, 0.6, 0.3 * radius, 0.3 * radius, share), rng)) << share;
  }
  EXPECT_TRUE(comes_out(shapes::tube(0.3, 0.6, -0.1, 0.1, 48), can(1, 0.6, 0.2, 0.2, 0.5), {0, -3, 0}));
}

TEST(Caged, NotInACanWithAWindowInItsSideHoweverSmallTheOtherOpenings) {
  Rng rng(11);
  for (int i = 0; i < 4; ++i) {
    const double radius = rng.uniform(0.5, 0.8);
    const Mesh can = shapes::can_with_window(1, 0.6, 0.3 * radius, 0.3 * radius, 24);
    EXPECT_FALSE(look(ring(radius, rng), can, rng)) << radius;
    EXPECT_TRUE(comes_out(shapes::tube(0.5 * radius, radius, -0.1, 0.1, 48), can, {0, 3, 0})) << radius;
  }
}

TEST(Caged, NotBesideACanOrAroundIt) {
  Rng rng(4);
  const Mesh small = can(1, 0.6, 0.2, 0.2);
  EXPECT_FALSE(look(moved(ring(0.8, rng), shapes::shift({0, 0, 0.8})), small, rng));
  EXPECT_FALSE(look(shapes::tube(1.35, 1.6, -0.1, 0.1, 48), small, rng));
}

TEST(Caged, ABarWithASharpBendOnBothSidesOfAHole) {
  Rng rng(5);
  for (int i = 0; i < 4; ++i) {
    const double half = rng.uniform(0.08, 0.12), thick = rng.uniform(3, 6) * half;
    const double bend = rng.uniform(80, 100) * pi / 180, legs = rng.uniform(1, 2);
    const double reach = 0.5 * thick + half * rng.uniform(1.5, 3);
    const Mesh bar = shapes::bent_bar(crank(-reach, reach, bend, bend, legs), half);
    const auto cage = look(bar, shapes::plate(half * rng.uniform(1.5, 1.7), thick), rng);
    ASSERT_TRUE(cage) << half << " thick " << thick << " bend " << bend;
    EXPECT_EQ(cage->kind, Cage::Kind::hook);
    EXPECT_EQ(cage->inside, 0u);
  }
}

TEST(Caged, NotWhereABendIsMissingOrTheHoleIsWide) {
  Rng rng(6);
  for (int i = 0; i < 2; ++i) {
    const double half = rng.uniform(0.08, 0.12), thick = rng.uniform(1, 4) * half, reach = 0.5 * thick + 2 * half;
    const Mesh one_bend = shapes::bent_bar(crank(-reach, 1, pi / 2, 0, 1), half);
    EXPECT_FALSE(look(one_bend, shapes::plate(1.6 * half, thick), rng));
    EXPECT_TRUE(comes_out(one_bend, shapes::plate(1.6 * half, thick), {0, 0, -4}));
    // Through this one the bar can be led like a thread: its bends have room to turn in it.
    const Mesh two_bends = shapes::bent_bar(crank(-reach, reach, pi / 2, pi / 2, 1), half);
    EXPECT_FALSE(look(two_bends, shapes::plate(6 * half, thick), rng));
    // Nor where the bends are gentle.
    const Mesh gentle = shapes::bent_bar(crank(-reach, reach, pi / 7, pi / 7, 1), half);
    EXPECT_FALSE(look(gentle, shapes::plate(2 * half, thick), rng));
  }
}

TEST(Caged, NotWhereTheBarIsThinnerThanWhatIsAllowed) {
  Rng rng(7);
  const Mesh wire = shapes::bent_bar(crank(-0.3, 0.3, pi / 2, pi / 2, 1), 0.9 * kAllowed);
  EXPECT_FALSE(look(wire, shapes::plate(1.6 * kAllowed, 0.4), rng));
}

/// A spool about z whose neck has radius `neck`, with rims at +-0.2.
Mesh spool(double neck, double below, double above) {
  return shapes::lathe(
      {{0.05, -0.4}, {below, -0.4}, {below, -0.2}, {neck, -0.2}, {neck, 0.2}, {above, 0.2}, {above, 0.4}, {0.05, 0.4}},
      40);
}

TEST(Caged, ASpoolWhoseRimsAreTooWideForTheHole) {
  Rng rng(9);
  for (int i = 0; i < 12; ++i) {
    const double hole = rng.uniform(0.3, 0.6), neck = hole * rng.uniform(0.5, 0.97);
    const double below = hole + rng.uniform(0.05, 0.3), above = hole + rng.uniform(0.05, 0.3);
    const Pose at = shapes::shift(Vec3(rng.uniform(-0.3, 0.3) * (hole - neck), 0, rng.uniform(-0.03, 0.03)));
    const auto cage = look(moved(spool(neck, below, above), at), shapes::plate(hole, 0.3), rng);
    ASSERT_TRUE(cage) << hole << " neck " << neck << " rims " << below << ' ' << above;
    EXPECT_EQ(cage->kind, Cage::Kind::spool);
    EXPECT_EQ(cage->inside, 0u);
    EXPECT_LE(cage->size, 2 * std::min(below, above) + 1e-9);
    EXPECT_GE(cage->opening, 2 * (hole + kAllowed) * 0.99);
    EXPECT_LT(cage->opening, cage->size);
  }
}

TEST(Caged, NotASpoolOneOfWhoseRimsGoesThroughWithinWhatIsAllowed) {
  Rng rng(10);
  for (int i = 0; i < 4; ++i) {
    const double hole = rng.uniform(0.3, 0.6), neck = 0.8 * hole, narrow = hole + rng.uniform(-0.05, 0.9 * kAllowed);
    const bool below = rng.uniform() < 0.5;
    const Mesh s = spool(neck, below ? narrow : 2 * hole, below ? 2 * hole : narrow);
    EXPECT_FALSE(look(s, shapes::plate(hole, 0.3), rng)) << hole << " rim " << narrow;
    if (narrow < hole - 0.01) {
      EXPECT_TRUE(comes_out(s, shapes::plate(hole, 0.3), {0, 0, below ? 3.0 : -3.0}));
    }
  }
  // Beside the hole, or above the plate, wide rims hold nothing.
  EXPECT_FALSE(look(moved(spool(0.3, 0.8, 0.8), shapes::shift({0, 0, 0.6})), shapes::plate(0.4, 0.3), rng));
}

TEST(Caged, AFlatPieceInACanWithAWindowThatItDoesNotPass) {
  Rng rng(9);
  const Mesh disc = shapes::tube(0, 0.9, -0.05, 0.05, 48);
  for (const std::uint32_t sectors : {6u, 24u}) {  // of 48: a chord of 0.77, and as wide as the can
    const Pose turned = random_pose(rng, 2);
    const Assembly assembly =
        assembly_of({moved(disc, turned), moved(shapes::can_with_window(1, 0.6, 0.3, 0.3, sectors), turned)});
    const Verifier verifier(assembly, {kAllowed});
    EXPECT_FALSE(verifier.caged(0, 1)) << "not a matter of openings that are all round";
    EXPECT_FALSE(verifier.caged_flat(1, 0, {})) << "the can is in no chamber of the disc";
    const auto cage = verifier.caged_flat(0, 1, {});
    ASSERT_EQ(cage.has_value(), sectors == 6) << sectors;
    if (!cage) continue;
    EXPECT_EQ(cage->kind, Cage::Kind::disc);
    EXPECT_EQ(cage->inside, 0u);
    EXPECT_EQ(cage->other, 1u);
    EXPECT_GT(cage->size, 1.6);
    EXPECT_LT(cage->size, 1.8);
    const std::string text = describe(*cage, assembly);
    for (const char* said : {"'part0'", "'part1'", "flat disc"}) EXPECT_NE(text.find(said), std::string::npos) << text;
  }
}

TEST(Caged, SaysWhoAndWhere) {
  Rng rng(8);
  Assembly assembly = assembly_of({ring(0.8, rng), can(1, 0.6, 0.3, 0.3)});
  assembly.normalization.scale = 0.5;
  const Verifier verifier(assembly, {kAllowed});
  const auto cage = verifier.caged(0, 1);
  ASSERT_TRUE(cage);
  const std::string text = describe(*cage, assembly);
  EXPECT_NE(text.find("'part0'"), std::string::npos) << text;
  EXPECT_NE(text.find("'part1'"), std::string::npos) << text;
}

}  // namespace
}  // namespace dismantle
