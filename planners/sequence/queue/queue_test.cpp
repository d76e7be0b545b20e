#include "queue/queue.h"

#include <gtest/gtest.h>

#include "dismantle/testing/fake_oracle.h"

namespace dismantle {
namespace {

TEST(Queue, FailedPartsGoToTheBack) {
  FakeMachine machine(4);
  machine.before[0] = {2};
  machine.before[1] = {0};
  QueueParameters params;
  params.order = PartOrder::as_given;
  Queue planner(params);
  const FakeRun run = run_on(planner, machine, seeded(1));
  expect_lawful(run, machine);
  std::vector<PartId> parts;
  for (const auto& [part, depth] : run.asked) {
    parts.push_back(part);
    EXPECT_EQ(depth, 0u);
  }
  EXPECT_EQ(parts, (std::vector<PartId>{0, 1, 2, 3, 0}));  // after 0 only 1 is left
  EXPECT_EQ(run.notes.order, (std::vector<PartId>{2, 3, 0}));
}

TEST(Queue, SolvesEveryMachineThatHasAnOrder) {
  Rng rng(11);
  for (int trial = 0; trial < 200; ++trial) {
    const FakeMachine machine = FakeMachine::random(1 + rng.below(20), 0.5, 5, rng);
    Queue planner(QueueParameters{});
    const FakeRun run = run_on(planner, machine, seeded(1));
    expect_lawful(run, machine);
    EXPECT_EQ(run.result.outcome, Outcome::solved);
    EXPECT_LE(run.asked.size(), machine.size() * machine.size());
  }
}

TEST(Queue, EndsWhenAllFailedSinceTheLastRemoval) {
  FakeMachine machine(5);
  machine.before = {{1}, {0}, {}, {0}, {1}};
  Queue planner(QueueParameters{});
  const FakeRun run = run_on(planner, machine, seeded(1));
  expect_lawful(run, machine);
  EXPECT_EQ(run.result.outcome, Outcome::exhausted);
  EXPECT_EQ(run.notes.order, (std::vector<PartId>{2}));
  EXPECT_EQ(run.asked.size(), 7u);  // 0 1 2, then 3 4 0 1
}

TEST(Queue, ParametersAreDeclaredInFull) { EXPECT_TRUE(problems_of_schema(Schema<QueueParameters>().specs()).empty()); }

}  // namespace
}  // namespace dismantle
