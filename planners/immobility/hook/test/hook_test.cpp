// A bent bar is called caged only when neither of its bends can follow through the hole.
#include "hook/hook.h"

#include <gtest/gtest.h>

#include <numbers>

#include "dismantle/testing/trials.h"
#include "prover_rig.h"

namespace dismantle::immobility {
namespace {

using shapes::crank;
using shapes::Vec3;
using std::numbers::pi;

constexpr double kAllowed = 0.01;

std::optional<Certificate> certificate_of(const Mesh& a, const Mesh& b, Rng& rng) {
  return prove_pair(Hook{}, "hook", a, b, kAllowed, rng);
}

bool comes_out(const Mesh& part, const Mesh& of, const Vec3& by) {
  return immobility::comes_out(part, of, by, kAllowed);
}

TEST(Hook, ABarWithASharpBendOnBothSidesOfAHole) {
  Rng rng(5);
  for (int i = 0; i < testing_support::trials(2, 12); ++i) {
    const double half = rng.uniform(0.08, 0.12), thick = rng.uniform(3, 6) * half;
    const double bend = rng.uniform(80, 100) * pi / 180, legs = rng.uniform(1, 2);
    const double reach = 0.5 * thick + half * rng.uniform(1.5, 3);
    const Mesh bar = shapes::bent_bar(crank(-reach, reach, bend, bend, legs), half);
    const auto cage = certificate_of(bar, shapes::plate(half * rng.uniform(1.5, 1.7), thick), rng);
    ASSERT_TRUE(cage) << half << " thick " << thick << " bend " << bend;
    EXPECT_EQ(cage->parts, (std::vector<PartId>{0, 1}));
  }
}

TEST(Hook, NotWhereABendIsMissingOrTheHoleIsWide) {
  Rng rng(6);
  for (int i = 0; i < testing_support::trials(1, 6); ++i) {
    const double half = rng.uniform(0.08, 0.12), thick = rng.uniform(1, 4) * half, reach = 0.5 * thick + 2 * half;
    const Mesh one_bend = shapes::bent_bar(crank(-reach, 1, pi / 2, 0, 1), half);
    EXPECT_FALSE(certificate_of(one_bend, shapes::plate(1.6 * half, thick), rng));
    EXPECT_TRUE(comes_out(one_bend, shapes::plate(1.6 * half, thick), {0, 0, -4}));
    // The bar can be threaded through this hole, where its bends have room to turn.
    const Mesh two_bends = shapes::bent_bar(crank(-reach, reach, pi / 2, pi / 2, 1), half);
    EXPECT_FALSE(certificate_of(two_bends, shapes::plate(6 * half, thick), rng));
    // Nor where the bends are gentle.
    const Mesh gentle = shapes::bent_bar(crank(-reach, reach, pi / 7, pi / 7, 1), half);
    EXPECT_FALSE(certificate_of(gentle, shapes::plate(2 * half, thick), rng));
  }
}

TEST(Hook, NotWhereTheBarIsThinnerThanWhatIsAllowed) {
  Rng rng(7);
  const Mesh wire = shapes::bent_bar(crank(-0.3, 0.3, pi / 2, pi / 2, 1), 0.9 * kAllowed);
  EXPECT_FALSE(certificate_of(wire, shapes::plate(1.6 * kAllowed, 0.4), rng));
}

}  // namespace
}  // namespace dismantle::immobility
