#include "contact_law.h"

#include <gtest/gtest.h>

#include <random>

#include "dismantle/statics/verdict.h"
#include "piles.h"

namespace dismantle::statics {
namespace {

using namespace testing;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

TEST(ContactLaw, ResistanceIsMinusTheDerivativeOfTheForce) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 n = vector().normalized(), moved = vector(), change = vector();
    const double friction = std::abs(normal(random));
    const auto check = [&](auto law) {
      Mat3 resistance;
      const Vec3 force = law(moved, n, friction, &resistance);
      EXPECT_EQ(force, law(moved, n, friction, nullptr));
      const double h = 1e-6;
      const Vec3 slope =
          (law(moved + h * change, n, friction, nullptr) - law(moved - h * change, n, friction, nullptr)) / (2 * h);
      EXPECT_LT((slope + resistance * change).norm(), 1e-4) << trial;
    };
    check(associated_force);
    check(limited_force);
    check(coulomb_force);
  }
}

TEST(ContactLaw, NothingPullsWithoutFriction) {
  for (const double friction : {0.0, 0.3}) {
    EXPECT_EQ(associated_force({0, 0, 1}, {0, 0, 1}, friction), Vec3::Zero());
    EXPECT_EQ(coulomb_force({0, 0, 1}, {0, 0, 1}, friction), Vec3::Zero());
    // A block under a ceiling.
    const Pile pile = pile_of({box({-1, -1, 0}, {1, 1, 1}), box({-1, -1, -1}, {1, 1, 0})}, 1, friction);
    ASSERT_FALSE(pile.contacts.empty());
    EXPECT_EQ(judge(pile).verdict, Verdict::falls) << friction;
    EXPECT_EQ(judge_forces(pile).verdict, Verdict::falls) << friction;
  }
}

}  // namespace
}  // namespace dismantle::statics
