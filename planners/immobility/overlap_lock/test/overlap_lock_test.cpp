// Overlapping parts are called locked only when no valid motion separates them.
#include "overlap_lock/overlap_lock.h"

#include <gtest/gtest.h>

#include "prover_rig.h"

namespace dismantle::immobility {
namespace {

using shapes::append;
using shapes::assembly_of;
using shapes::box;
using shapes::moved;
using shapes::random_pose;
using shapes::Vec3;

constexpr double kAllowed = 0.01;

/// A plate and a pin through it, whose head and foot extend beyond the hole's edge so that the overlap is `deep`.
Assembly pinned(double overlap, const Pose& at) {
  const Mesh plate = box({-2, -2, -0.5}, {2, 2, 0.5});
  const Mesh pin = box({-0.3, -0.3, -1}, {0.3, 0.3, 1});
  Assembly assembly = assembly_of({moved(plate, at), moved(pin, at)});
  assembly.overlaps = {{0, 1, overlap}};
  return assembly;
}

TEST(OverlapLock, APinThroughAPlateWhoseOverlapIsCalledSmall) {
  Rng rng(1);
  for (int i = 0; i < 20; ++i) {
    // No point of both is more than 0.5 below the surface of the plate: with a larger allowance the pin could leave.
    // The prover samples, and need not find the deepest tenth.
    const double overlap = rng.uniform(0.01, 0.6);
    const ProverRig rig(pinned(overlap, random_pose(rng, 2)), kAllowed);
    const auto found = rig.prove(OverlapLock{}, {1}, {0});
    if (!found) {
      EXPECT_GT(overlap + kAllowed, 0.4);
      continue;
    }
    ASSERT_LT(overlap + kAllowed, 0.5);
    EXPECT_GT(found->numbers.at("depth").front(), overlap + kAllowed);
    EXPECT_EQ(rig.objection(OverlapLock{}, "overlap_lock", *found), "");
    for (const Vec3& by : {Vec3(5, 0, 0), Vec3(0.6, 0.6, 0)}) {
      Certificate forged = *found;
      for (int k = 0; k < 3; ++k) forged.numbers.at("point")[static_cast<std::size_t>(k)] += by[k];
      EXPECT_NE(rig.objection(OverlapLock{}, "overlap_lock", forged), "");
    }
  }
}

TEST(OverlapLock, NotWithoutOverlap) {
  Assembly assembly = pinned(0.1, Pose{});
  assembly.overlaps.clear();
  EXPECT_FALSE(ProverRig(assembly, kAllowed).prove(OverlapLock{}, {0}, {1}));
}

TEST(OverlapLock, NotWhereTheVerifierLetsThemPart) {
  Rng rng(2);
  for (int i = 0; i < 10; ++i) {
    // Pressed into a wall from one side, no deeper than measured.
    const double deep = rng.uniform(0.01, 0.3);
    Assembly assembly = assembly_of({box({-1, -1, -deep}, {1, 1, 1}), box({-2, -2, -1}, {2, 2, 0})});
    assembly.overlaps = {{0, 1, deep}};
    const Verifier verifier(assembly, {kAllowed});
    ASSERT_TRUE(verifier.check_motion({0}, {{1, Pose{}}}, {{Pose{}}, {shapes::shift({0, 0, 3})}}).valid) << deep;
    EXPECT_FALSE(ProverRig(assembly, kAllowed).prove(OverlapLock{}, {0}, {1})) << deep;
  }
}

}  // namespace
}  // namespace dismantle::immobility
