// A spool is called caged only when both rims are too wide for the hole.
#include "spool/spool.h"

#include <gtest/gtest.h>

#include <numbers>

#include "dismantle/testing/trials.h"
#include "prover_rig.h"

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

}  // namespace
}  // namespace dismantle::immobility
