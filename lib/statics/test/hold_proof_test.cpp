// Law: what is written of a proof of holds says what the proof says, however far the pile gives way.
#include "dismantle/statics/hold_proof.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "dismantle/statics/verdict.h"
#include "piles.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;

// A block on a smooth table may slide any way without a force: displacements that differ by that create the same
// forces.
TEST(HoldProof, LargeDisplacementsKeepTheirForces) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(uniform(random), uniform(random), uniform(random), uniform(random)).normalized();
    const Vec3 up = turn * Vec3::UnitZ();
    Pile pile{{{2, turn * Vec3(0, 0, 1), 1.5, false}, {0, Vec3::Zero(), 1, true}}, {}, -up};
    Contact contact;
    contact.a = 0;
    contact.b = 1;
    contact.normal = up;
    contact.friction = 0;
    for (const double x : {-1.0, 1.0})
      for (const double y : {-1.0, 1.0}) contact.points.push_back(turn * Vec3(x, y, 0));
    pile.contacts.push_back(contact);
    Judgement found = judge_forces(pile);
    ASSERT_EQ(found.verdict, Verdict::stands);
    found.displacement[0].v += std::pow(10, 4 * (1 + uniform(random))) * (turn * Vec3(0.6, 0.8, 0));
    Numbers numbers;
    add_hold_proof({{}, found.displacement, {}}, pile, "after", numbers);
    const std::optional<HoldProof> read = hold_proof_in(numbers, "after", pile);
    ASSERT_TRUE(read);
    EXPECT_EQ(check_hold_proof(pile, *read), "") << "trial " << trial;
  }
}

}  // namespace
}  // namespace dismantle::statics
