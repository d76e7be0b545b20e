#include "random/random.h"

#include <gtest/gtest.h>

#include <set>

#include "dismantle/testing/fake_oracle.h"

namespace dismantle {
namespace {

TEST(Random, SameSeedSameOrderOtherSeedsOtherOrders) {
  const FakeMachine machine(8);
  std::set<std::vector<PartId>> orders;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random planner(RandomParameters{});
    const FakeRun a = run_on(planner, machine, seeded(seed));
    const FakeRun b = run_on(planner, machine, seeded(seed));
    expect_lawful(a, machine);
    EXPECT_EQ(a.asked, b.asked);
    EXPECT_EQ(a.notes.order, b.notes.order);
    orders.insert(a.notes.order);
  }
  EXPECT_GT(orders.size(), 45u);
}

TEST(Random, EveryPartIsEquallyLikelyToGoFirst) {
  const FakeMachine machine(4);
  std::vector<int> first(4, 0);
  for (std::uint64_t seed = 1; seed <= 4000; ++seed) {
    Random planner(RandomParameters{});
    ++first[run_on(planner, machine, seeded(seed)).notes.order.at(0)];
  }
  for (const int n : first) EXPECT_NEAR(n, 1000, 150);  // 5 standard deviations
}

TEST(Random, SolvesEveryMachineThatHasAnOrder) {
  Rng rng(13);
  for (int trial = 0; trial < 200; ++trial) {
    const FakeMachine machine = FakeMachine::random(1 + rng.below(15), 0.5, 5, rng);
    Random planner(RandomParameters{});
    const FakeRun run = run_on(planner, machine, seeded(static_cast<std::uint64_t>(trial)));
    expect_lawful(run, machine);
    EXPECT_EQ(run.result.outcome, Outcome::solved);
  }
}

TEST(Random, TriesEachPartOnceBeforeItGivesUp) {
  FakeMachine machine(4);
  machine.before = {{1}, {2}, {3}, {0}};
  Random planner(RandomParameters{});
  const FakeRun run = run_on(planner, machine, seeded(3));
  expect_lawful(run, machine);
  EXPECT_EQ(run.result.outcome, Outcome::exhausted);
  std::set<PartId> asked;
  for (const auto& [part, depth] : run.asked) asked.insert(part);
  EXPECT_EQ(run.asked.size(), 4u);
  EXPECT_EQ(asked.size(), 4u);
}

TEST(Random, ParametersAreDeclaredInFull) {
  EXPECT_TRUE(problems_of_schema(Schema<RandomParameters>().specs()).empty());
}

}  // namespace
}  // namespace dismantle
