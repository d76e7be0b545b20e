#include "progressive/progressive.h"

#include <gtest/gtest.h>

#include "dismantle/testing/fake_oracle.h"

namespace dismantle {
namespace {

using Asked = std::vector<std::pair<PartId, unsigned>>;

ProgressiveParameters algorithm_2() {
  ProgressiveParameters params;
  params.deepen_always = true;
  params.last_pair_unlimited = false;
  return params;
}

ProgressiveParameters as_given() {
  ProgressiveParameters params = algorithm_2();
  params.order = PartOrder::as_given;
  return params;
}

TEST(Progressive, FollowsAlgorithm2StepByStep) {
  FakeMachine machine(4);
  machine.before[0] = {1};  // 1 has to leave first
  machine.depth = {1, 2, 1, 5};
  Progressive planner(as_given());
  const FakeRun run = run_on(planner, machine, seeded(1));
  expect_lawful(run, machine);
  // Round 1: 0 is blocked, 1 needs more depth, 2 leaves, 3 needs more. Round 2: 0 still waits for 1, 1 leaves, 3 needs
  // more. Round 3: 0 leaves, 3 is the last part.
  EXPECT_EQ(run.asked, (Asked{{0, 1}, {1, 1}, {2, 1}, {3, 1}, {0, 2}, {1, 2}, {3, 2}, {0, 3}}));
  EXPECT_EQ(run.notes.order, (std::vector<PartId>{2, 1, 0}));
  EXPECT_EQ(run.result.outcome, Outcome::solved);
  EXPECT_EQ(run.result.remaining, (std::vector<PartId>{3}));
}

TEST(Progressive, AsksAtMostRoundsTimesParts) {
  Rng rng(7);
  for (int trial = 0; trial < 200; ++trial) {
    const FakeMachine machine = FakeMachine::random(2 + rng.below(20), 0.3, 4, rng);
    Progressive planner(algorithm_2());
    const FakeRun run = run_on(planner, machine, seeded(1));
    expect_lawful(run, machine);
    EXPECT_EQ(run.result.outcome, Outcome::solved);
    unsigned rounds = 0;
    for (const auto& [part, depth] : run.asked) rounds = std::max(rounds, depth);
    EXPECT_LE(run.asked.size(), rounds * machine.size());
    // Each round after the deepest removal needs removes at least one part.
    EXPECT_LE(rounds, 4 + machine.size());
  }
}

TEST(Progressive, EndsWhenMoreDepthCannotHelp) {
  FakeMachine machine(3);
  machine.before = {{1}, {0}, {0}};  // 0 and 1 hold each other
  Progressive planner(algorithm_2());
  const FakeRun run = run_on(planner, machine, seeded(1));
  expect_lawful(run, machine);
  EXPECT_EQ(run.result.outcome, Outcome::exhausted);
  EXPECT_EQ(run.asked.size(), 3u);  // one round
  for (const auto& u : run.result.unsolved) {
    EXPECT_EQ(u.outcome, Outcome::exhausted);
    EXPECT_FALSE(u.blocked_by.empty());
    EXPECT_EQ(u.best_pose.size(), 1u);
    EXPECT_EQ(u.message, "blocked");
  }
}

TEST(Progressive, RepeatsRoundsAtTheDepthCap) {
  FakeMachine machine(4);
  machine.before = {{1}, {2}, {3}, {}};  // only order 3 2 1, against the order of trying: one removal per round
  machine.depth = {2, 2, 2, 2};
  ProgressiveParameters params = as_given();
  params.max_depth = 2;
  Progressive planner(params);
  const FakeRun run = run_on(planner, machine, seeded(1));
  expect_lawful(run, machine);
  EXPECT_EQ(run.result.outcome, Outcome::solved);
  EXPECT_EQ(run.notes.order, (std::vector<PartId>{3, 2, 1}));
  for (const auto& [part, depth] : run.asked) EXPECT_LE(depth, 2u);
}

TEST(Progressive, SaysThatTheDepthCapWasInTheWay) {
  FakeMachine machine(2);
  machine.depth = {5, 5};
  ProgressiveParameters params = algorithm_2();
  params.max_depth = 3;
  Progressive planner(params);
  const FakeRun run = run_on(planner, machine, seeded(1));
  expect_lawful(run, machine);
  EXPECT_EQ(run.result.outcome, Outcome::depth_limit);
  EXPECT_EQ(run.asked.size(), 6u);
}

TEST(Progressive, TriesPartsInTheOrderChosen) {
  FakeMachine machine(3);
  machine.volume = {5, 1, 9};
  const auto first_asked = [&](PartOrder order) {
    ProgressiveParameters params = algorithm_2();
    params.order = order;
    Progressive planner(params);
    return run_on(planner, machine, seeded(1)).asked.at(0).first;
  };
  EXPECT_EQ(first_asked(PartOrder::small_first), 1u);
  EXPECT_EQ(first_asked(PartOrder::as_given), 0u);
  EXPECT_EQ(first_asked(PartOrder::large_first), 2u);
}

TEST(Progressive, HintsOnlyWhenThereAreThreads) {
  const Assembly assembly = FakeMachine(6).assembly();
  for (const unsigned threads : {1u, 2u}) {
    FakeOracle oracle{FakeMachine(6)};
    Notes notes;
    RunContext context;
    context.threads = threads;
    Progressive planner(algorithm_2());
    const Constraints constraints;
    const Objective objective;
    planner.plan({assembly, whole_assembly(assembly), constraints, objective}, oracle, notes, context);
    EXPECT_EQ(oracle.hinted > 0, threads > 1);
  }
}

TEST(Progressive, ParametersAreDeclaredInFull) {
  EXPECT_TRUE(problems_of_schema(Schema<ProgressiveParameters>().specs()).empty());
}

TEST(Progressive, GivesTheLastTwoPartsAllTheDepthTheyNeed) {
  FakeMachine machine(3);
  machine.depth = {1, 7, 9};
  Progressive planner(ProgressiveParameters{});
  const FakeRun run = run_on(planner, machine, seeded(1));
  expect_lawful(run, machine);
  EXPECT_EQ(run.result.outcome, Outcome::solved);
  EXPECT_EQ(run.asked.back().second, 0u) << "0 = no limit";
}

TEST(Progressive, StaysAtADepthAsLongAsPartsLeave) {
  FakeMachine machine(5);
  machine.before = {{1}, {2}, {3}, {}, {0}};  // against the order of trying: one removal per round
  machine.depth = {1, 1, 1, 1, 2};
  ProgressiveParameters params = as_given();
  params.deepen_always = false;
  Progressive planner(params);
  const FakeRun run = run_on(planner, machine, seeded(1));
  expect_lawful(run, machine);
  EXPECT_EQ(run.result.outcome, Outcome::solved);
  EXPECT_EQ(run.notes.order, (std::vector<PartId>{3, 2, 1, 0}));
  for (const auto& [part, depth] : run.asked) EXPECT_EQ(depth, 1u);
}

}  // namespace
}  // namespace dismantle
