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

/// A disc in a can whose upper opening is smaller than the disc by `lip` all around.
Assembly snapped_disc(double lip) {
  const double radius = 0.99;
  const Mesh disc = shapes::lathe({{0.2, -0.49}, {radius, -0.49}, {radius, 0.49}, {0.2, 0.49}}, 48);
  return shapes::assembly_of({shapes::can(1, 1, 0.5, radius - lip), disc});
}

TEST(SnapDepth, PairsThatAFewTolerancesHoldAreAskedNoProofOfHighEffort) {
  const double tolerance = RunOptions{}.verify.max_penetration;
  for (const auto& [lip, expected] : {std::pair(3 * tolerance, 0), std::pair(10 * tolerance, 1)}) {
    int asked = 0;
    const auto nothing = [](const PathQuery&, RunContext&) { return fake::outcome(Outcome::exhausted); };
    PlanningSetup setup = fake::setup(nothing);
    setup.provers = {fake::prover("high", {ProofEffort::high, 2, 2, false},
                                  [&](const SeparationQuery& q, const RunContext&) -> std::optional<Certificate> {
                                    ++asked;
                                    return fake::claim(q);
                                  })};
    fake::Rig s(snapped_disc(lip), std::move(setup));
    EXPECT_EQ(s.ask(fake::leave(s.assembly, 1)).certificate != nullptr, expected > 0) << lip;
    EXPECT_EQ(asked, expected) << lip;
  }
}

}  // namespace
}  // namespace dismantle
