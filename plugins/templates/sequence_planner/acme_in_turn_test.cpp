// Tests of acme.in_turn beyond the laws of its kind, which `dismantle plugins check` tests.
#include <gtest/gtest.h>

#include "dismantle/host/registry.h"
#include "dismantle/testing/fake_oracle.h"

namespace {

/// Runs the planner with these parameters; the oracle knows the precedence of the parts.
dismantle::FakeRun run(const dismantle::FakeMachine& machine, const dismantle::ParamSet& params = {}) {
  dismantle::Registry registry;
  registry.load(PLUGIN_FILE);
  const auto planner = registry.create<dismantle::SequencePlanner>("acme.in_turn", params);
  return dismantle::run_on(*planner, machine, dismantle::seeded(1));
}

TEST(AcmeInTurn, TheSmallestGoFirst) {
  dismantle::FakeMachine machine(4);
  machine.volume = {4, 1, 3, 2};
  const auto done = run(machine);
  dismantle::expect_lawful(done, machine);
  EXPECT_EQ(done.notes.order, (std::vector<dismantle::PartId>{1, 3, 2}));
}

TEST(AcmeInTurn, GoesNoDeeperThanItIsTold) {
  dismantle::Rng rng(2);
  for (int trial = 0; trial < 20; ++trial) {
    const unsigned needed = 2 + static_cast<unsigned>(rng.below(4));
    dismantle::FakeMachine machine(3);
    machine.depth = {needed, needed, needed};
    const auto enough = run(machine, {{"max_depth", static_cast<std::int64_t>(needed)}});
    dismantle::expect_lawful(enough, machine);
    EXPECT_EQ(enough.result.outcome, dismantle::Outcome::solved);
    const auto too_little = run(machine, {{"max_depth", static_cast<std::int64_t>(needed - 1)}});
    dismantle::expect_lawful(too_little, machine);
    EXPECT_EQ(too_little.result.outcome, dismantle::Outcome::depth_limit);
    for (const auto& [part, depth] : too_little.asked) EXPECT_LT(depth, needed);
  }
}

}  // namespace
