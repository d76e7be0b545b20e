// A spool is called caged only when both rims are too wide for the hole.
#include "spool/spool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dismantle/testing/trials.h"
#include "prover_rig.h"
#include "spool/spool_cage.h"

namespace dismantle::immobility {
namespace {

using shapes::moved;
using shapes::Vec3;

constexpr double kAllowed = 0.01;

std::optional<Certificate> certificate_of(const Mesh& a, const Mesh& b, Rng& rng) {
  return prove_pair(Spool{}, "spool", a, b, kAllowed, rng);
}

bool comes_out(const Mesh& part, const Mesh& of, const Vec3& by) {
  return immobility::comes_out(part, of, by, kAllowed);
}

/// A spool about z whose neck has radius `neck`, with rims at +-0.2.
Mesh spool(double neck, double below, double above) {
  return shapes::lathe(
      {{0.05, -0.4}, {below, -0.4}, {below, -0.2}, {neck, -0.2}, {neck, 0.2}, {above, 0.2}, {above, 0.4}, {0.05, 0.4}},
      40);
}

TEST(Spool, ASpoolWhoseRimsAreTooWideForTheHole) {
  Rng rng(9);
  for (int i = 0; i < 12; ++i) {
    const double hole = rng.uniform(0.3, 0.6), neck = hole * rng.uniform(0.5, 0.97);
    const double below = hole + rng.uniform(0.05, 0.3), above = hole + rng.uniform(0.05, 0.3);
    const Pose at = shapes::shift(Vec3(rng.uniform(-0.3, 0.3) * (hole - neck), 0, rng.uniform(-0.03, 0.03)));
    const auto cage = certificate_of(moved(spool(neck, below, above), at), shapes::plate(hole, 0.3), rng);
    ASSERT_TRUE(cage) << hole << " neck " << neck << " rims " << below << ' ' << above;
    EXPECT_EQ(cage->parts, (std::vector<PartId>{0, 1}));
    EXPECT_LE(cage->numbers.at("rim").front(), 2 * std::min(below, above) + 1e-9);
    EXPECT_GE(cage->numbers.at("circle").front(), 2 * (hole + kAllowed) * 0.99);
    EXPECT_LT(cage->numbers.at("circle").front(), cage->numbers.at("rim").front());
  }
}

TEST(Spool, NotASpoolOneOfWhoseRimsGoesThroughWithinWhatIsAllowed) {
  Rng rng(10);
  for (int i = 0; i < testing_support::trials(2, 12); ++i) {
    const double hole = rng.uniform(0.3, 0.6), neck = 0.8 * hole, narrow = hole + rng.uniform(-0.05, 0.9 * kAllowed);
    const bool below = rng.uniform() < 0.5;
    const Mesh s = spool(neck, below ? narrow : 2 * hole, below ? 2 * hole : narrow);
    EXPECT_FALSE(certificate_of(s, shapes::plate(hole, 0.3), rng)) << hole << " rim " << narrow;
    if (narrow < hole - 0.01) {
      EXPECT_TRUE(comes_out(s, shapes::plate(hole, 0.3), {0, 0, below ? 3.0 : -3.0}));
    }
  }
  // Beside the hole, or above the plate, wide rims hold nothing.
  EXPECT_FALSE(certificate_of(moved(spool(0.3, 0.8, 0.8), shapes::shift({0, 0, 0.6})), shapes::plate(0.4, 0.3), rng));
}

/// The inner radius of a nearly convex curve; none for a curve with a slit from side to side, although all of its
/// points are near the hull.
TEST(Spool, ARimWithASlitIsNotConvex) {
  Rng rng(11);
  for (int i = 0; i < 50; ++i) {
    constexpr double kDent = 1e-3;
    const std::size_t n = 2 * (4 + rng.below(20));
    const double radius = rng.uniform(0.5, 2);
    Loop rim;
    rim.plane = {Vec3::UnitZ(), 0};
    const auto at = [&](double turn, double r) {
      return Vec3(r * std::cos(2 * std::numbers::pi * turn), r * std::sin(2 * std::numbers::pi * turn), 0);
    };
    for (std::size_t k = 0; k < n; ++k) {
      rim.points.push_back(at(static_cast<double>(k) / static_cast<double>(n), radius));
      const double dent = rng.uniform(0, 0.9) * kDent;  // of the middle of the edge that follows
      rim.points.push_back(at((static_cast<double>(k) + 0.5) / static_cast<double>(n),
                              radius * std::cos(std::numbers::pi / static_cast<double>(n)) - dent));
    }
    const double inner = radius * std::cos(std::numbers::pi / static_cast<double>(n));
    EXPECT_NEAR(convex_reach(rim, Vec3::Zero(), 0, kDent), inner, 1e-9);
    // From the middle of an edge to just before that on the other side, and back.
    const double across = -(inner - 0.5 * kDent);
    rim.points.insert(rim.points.begin() + 2, {at(0.5 / static_cast<double>(n), across)});
    rim.points.insert(rim.points.begin() + 3, {at(0.5 / static_cast<double>(n), inner)});
    EXPECT_EQ(convex_reach(rim, Vec3::Zero(), 0, kDent), 0) << n;
  }
}

}  // namespace
}  // namespace dismantle::immobility
