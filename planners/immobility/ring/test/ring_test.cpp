// A ring is called caged only when no motion within the limits leads it out, at any pose of the assembly.
#include "ring/ring.h"

#include <gtest/gtest.h>

#include <numbers>

#include "dismantle/testing/trials.h"
#include "prover_rig.h"

namespace dismantle::immobility {
namespace {

using shapes::can;
using shapes::moved;
using shapes::Vec3;

constexpr double kAllowed = 0.01;

std::optional<Certificate> certificate_of(const Mesh& a, const Mesh& b, Rng& rng) {
  return prove_pair(Ring{}, "ring", a, b, kAllowed, rng);
}

bool comes_out(const Mesh& part, const Mesh& of, const Vec3& by) {
  return immobility::comes_out(part, of, by, kAllowed);
}

/// Somewhere in a can whose cavity is 1 wide and 0.6 high.
Mesh ring(double radius, Rng& rng) {
  const Pose at{0.02 * Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)),
                Eigen::Quaterniond(Eigen::AngleAxisd(rng.uniform(-0.05, 0.05), Vec3::UnitX()))};
  return moved(shapes::tube(0.5 * radius, radius, -0.1, 0.1, 48), at);
}

TEST(Ring, ARingInACanWithOpeningsThatAreTooSmall) {
  Rng rng(1);
  for (int i = 0; i < 12; ++i) {
    const double radius = rng.uniform(0.6, 0.9);
    const double below = radius * rng.uniform(0.1, 0.75), above = radius * rng.uniform(0.1, 0.75);
    const auto cage = certificate_of(ring(radius, rng), can(1, 0.6, below, above), rng);
    ASSERT_TRUE(cage) << radius << " behind " << below << " and " << above;
    EXPECT_EQ(cage->parts, (std::vector<PartId>{0, 1}));
    EXPECT_LE(cage->numbers.at("diameter").front(), 2 * radius - 2 * kAllowed);
    EXPECT_GE(cage->numbers.at("opening").front(), 2 * std::max(below, above) * 0.99);
    EXPECT_LT(cage->numbers.at("opening").front(), cage->numbers.at("diameter").front());
  }
}

TEST(Ring, NotWhereTheRingFitsThroughAnOpeningWithinWhatIsAllowed) {
  Rng rng(2);
  for (int i = 0; i < testing_support::trials(2, 12); ++i) {
    const double radius = rng.uniform(0.6, 0.9), opening = radius + rng.uniform(-0.9 * kAllowed, 0.08);
    EXPECT_FALSE(certificate_of(ring(radius, rng), can(1, 0.6, 0.2, opening), rng)) << radius << " behind " << opening;
    const Mesh straight = shapes::tube(0.5 * radius, radius, -0.1, 0.1, 48);
    if (opening > radius + kAllowed) {
      EXPECT_TRUE(comes_out(straight, can(1, 0.6, 0.2, opening), {0, 0, 3}));
    }
  }
}

TEST(Ring, NotInACanThatIsOpenAtItsSide) {
  Rng rng(3);
  for (int i = 0; i < testing_support::trials(2, 12); ++i) {
    const double radius = rng.uniform(0.5, 0.8), share = rng.uniform(0.5, 0.95);
    EXPECT_FALSE(certificate_of(ring(radius, rng), can(1, 0.6, 0.3 * radius, 0.3 * radius, share), rng)) << share;
  }
  EXPECT_TRUE(comes_out(shapes::tube(0.3, 0.6, -0.1, 0.1, 48), can(1, 0.6, 0.2, 0.2, 0.5), {0, -3, 0}));
}

TEST(Ring, NotInACanWithAWindowInItsSideHoweverSmallTheOtherOpenings) {
  Rng rng(11);
  for (int i = 0; i < testing_support::trials(2, 12); ++i) {
    const double radius = rng.uniform(0.5, 0.8);
    const Mesh can = shapes::can_with_window(1, 0.6, 0.3 * radius, 0.3 * radius, 24);
    EXPECT_FALSE(certificate_of(ring(radius, rng), can, rng)) << radius;
    EXPECT_TRUE(comes_out(shapes::tube(0.5 * radius, radius, -0.1, 0.1, 48), can, {0, 3, 0})) << radius;
  }
}

TEST(Ring, NotBesideACanOrAroundIt) {
  Rng rng(4);
  const Mesh small = can(1, 0.6, 0.2, 0.2);
  EXPECT_FALSE(certificate_of(moved(ring(0.8, rng), shapes::shift({0, 0, 0.8})), small, rng));
  EXPECT_FALSE(certificate_of(shapes::tube(1.35, 1.6, -0.1, 0.1, 48), small, rng));
}

}  // namespace
}  // namespace dismantle::immobility
