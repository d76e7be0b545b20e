// Pairs that snap are asked no proof of high effort.
#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "dismantle/run_context.h"
#include "dismantle/testing/fake_prover.h"
#include "dismantle/testing/held_shapes.h"
#include "dismantle/testing/oracle_rig.h"
#include "dismantle/testing/run_rig.h"

namespace dismantle {
namespace {

/// A disc of height 2 `half` in a can whose upper opening is smaller than the disc by `lip` all around.
Assembly snapped_disc(double lip, double half = 0.49) {
  const double radius = 0.99;
  const Mesh disc = shapes::lathe({{0.2, -half}, {radius, -half}, {radius, half}, {0.2, half}}, 48);
  return shapes::assembly_of({shapes::can(1, 1, 0.5, radius - lip), disc});
}

/// Times that a prover of high effort is asked about the disc.
int times_asked(Assembly assembly) {
  int asked = 0;
  const auto nothing = [](const PathQuery&, RunContext&) { return fake::outcome(Outcome::exhausted); };
  PlanningSetup setup = fake::setup(nothing);
  setup.provers = {fake::prover("high", {ProofEffort::high, 2, 2, false},
                                [&](const SeparationQuery& q, const RunContext&) -> std::optional<Certificate> {
                                  ++asked;
                                  return fake::claim(q);
                                })};
  fake::Rig s(std::move(assembly), std::move(setup));
  const bool proved = s.ask(fake::leave(s.assembly, 1)).certificate != nullptr;
  EXPECT_EQ(proved, asked > 0);
  return asked;
}

TEST(SnapDepth, PairsThatAFewTolerancesHoldAreAskedNoProofOfHighEffort) {
  const double tolerance = RunOptions{}.verify.max_penetration;
  EXPECT_EQ(times_asked(snapped_disc(3 * tolerance)), 0);
  EXPECT_EQ(times_asked(snapped_disc(10 * tolerance)), 1);
}

/// A thin disc may not pass a lip of less than the tolerance, since it is thinner than four times that. That cannot be
/// proved by depths alone.
TEST(SnapDepth, NorThoseThatOnlyAThinWallHolds) {
  const double tolerance = RunOptions{}.verify.max_penetration;
  EXPECT_EQ(times_asked(snapped_disc(0.9 * tolerance, tolerance)), 0);
}

}  // namespace
}  // namespace dismantle
