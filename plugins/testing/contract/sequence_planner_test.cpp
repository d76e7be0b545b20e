// Laws of all sequence planners with default parameters, on machines with known answers.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "dismantle/engine/run.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/testing/fake_oracle.h"
#include "dismantle/testing/fake_planning.h"
#include "selection.h"

namespace dismantle {
namespace {

using namespace contract;

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SequencePlannerContract);

/// A planner that works only by force takes nothing apart without it; only its declarations have laws.
class SequencePlannerContract : public testing::TestWithParam<std::string> {
 protected:
  static bool only_forces() { return make()->traits().forces; }
  static std::shared_ptr<SequencePlanner> make() { return registry().create<SequencePlanner>(GetParam()); }
  static FakeRun go(const FakeMachine& machine, RunContext context, std::function<void(std::size_t)> on_attempt = {}) {
    return run_on(*make(), machine, std::move(context), std::move(on_attempt));
  }
};

TEST_P(SequencePlannerContract, DeclaresItsParametersInFull) {
  const PluginType& type = registry().find(PluginKind::sequence_planner, GetParam()).type;
  EXPECT_TRUE(problems_of_schema(type.params).empty());
  EXPECT_FALSE(type.summary.empty());
}

TEST_P(SequencePlannerContract, TakesApartWhatCanBeTakenApart) {
  if (only_forces()) GTEST_SKIP() << "it removes parts by force only";
  Rng rng(101);
  for (int trial = 0; trial < 100; ++trial) {
    const unsigned depth = 1 + static_cast<unsigned>(rng.below(4));
    const FakeMachine machine = FakeMachine::random(2 + rng.below(15), rng.uniform(), depth, rng);
    const FakeRun run = go(machine, seeded(static_cast<std::uint64_t>(trial)));
    expect_lawful(run, machine);
    EXPECT_EQ(run.result.outcome, Outcome::solved);
    // Each round asks for every part once, and removes a part or increases the depth by one.
    EXPECT_LE(run.asked.size(), (machine.size() + depth) * machine.size());
  }
}

TEST_P(SequencePlannerContract, FindsTheOnlyOrder) {
  if (only_forces()) GTEST_SKIP() << "it removes parts by force only";
  for (const bool ascending : {false, true}) {
    FakeMachine machine(9);
    std::vector<PartId> order;
    for (PartId k = 0; k < 9; ++k) order.push_back(ascending ? k : 8 - k);
    for (std::size_t k = 1; k < 9; ++k) machine.before[order[k]] = {order[k - 1]};
    const FakeRun run = go(machine, seeded(1));
    expect_lawful(run, machine);
    order.pop_back();
    EXPECT_EQ(run.notes.order, order);
  }
}

TEST_P(SequencePlannerContract, NoticesADeadlock) {
  if (only_forces()) GTEST_SKIP() << "it removes parts by force only";
  Rng rng(102);
  for (int trial = 0; trial < 50; ++trial) {
    FakeMachine machine = FakeMachine::random(6, 0.3, 3, rng);
    machine.before[0].push_back(1);  // 0 and 1 wait for each other, so all parts that wait for them stay
    machine.before[1].push_back(0);
    const FakeRun run = go(machine, seeded(1));
    expect_lawful(run, machine);
    EXPECT_EQ(run.result.outcome, Outcome::exhausted);
    for (const auto& u : run.result.unsolved) EXPECT_FALSE(u.blocked_by.empty());
  }
}

TEST_P(SequencePlannerContract, SameSeedSameRun) {
  if (only_forces()) GTEST_SKIP() << "it removes parts by force only";
  Rng rng(103);
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const FakeMachine machine = FakeMachine::random(8, 0.3, 2, rng);
    const FakeRun a = go(machine, seeded(seed));
    const FakeRun b = go(machine, seeded(seed));
    EXPECT_EQ(a.asked, b.asked);
    EXPECT_EQ(a.notes.order, b.notes.order);
  }
}

TEST_P(SequencePlannerContract, StopsWhenToldAndKeepsWhatIsDone) {
  if (only_forces()) GTEST_SKIP() << "it removes parts by force only";
  const FakeMachine machine(10);
  RunContext context = seeded(1);
  const CancelToken cancel = context.cancel;
  const FakeRun run = go(machine, context, [&](std::size_t asked) {
    if (asked == 4) cancel.cancel();
  });
  expect_lawful(run, machine);
  EXPECT_EQ(run.result.outcome, Outcome::cancelled);
  EXPECT_EQ(run.result.removals.size(), 3u);
  EXPECT_LE(run.asked.size(), 5u);
  for (const auto& u : run.result.unsolved) EXPECT_EQ(u.outcome, Outcome::cancelled);
}

TEST_P(SequencePlannerContract, AfterTheDeadlineNothingIsAsked) {
  RunContext context = seeded(1);
  context.deadline = Deadline::after_seconds(0);
  const FakeMachine machine(3);
  const FakeRun run = go(machine, context);
  expect_lawful(run, machine);
  EXPECT_EQ(run.result.outcome, Outcome::timeout);
  EXPECT_TRUE(run.asked.empty());
}

TEST_P(SequencePlannerContract, OnePartIsNoWork) {
  const FakeRun run = go(FakeMachine(1), seeded(1));
  EXPECT_EQ(run.result.outcome, Outcome::solved);
  EXPECT_TRUE(run.asked.empty());
}

TEST_P(SequencePlannerContract, ReportsProgressThatGrows) {
  if (only_forces()) GTEST_SKIP() << "it removes parts by force only";
  RunContext context = seeded(1);
  std::size_t last = 0;
  bool complete = false;
  context.on_progress = [&](const ProgressEvent& e) {
    EXPECT_EQ(e.phase, "sequence");
    EXPECT_EQ(e.total, 6u);
    EXPECT_GE(e.done, last);
    EXPECT_LE(e.done, e.total);
    EXPECT_FALSE(e.detail.empty());
    last = e.done;
    complete = e.done == e.total;
  };
  go(FakeMachine(7), context);
  EXPECT_TRUE(complete);
}

// Real oracle and runner, boxes and a scripted path planner: the plan must not depend on the threads.
TEST_P(SequencePlannerContract, SamePlanOnAnyNumberOfThreads) {
  if (only_forces()) GTEST_SKIP() << "it removes parts by force only";
  const Assembly assembly = fake::tube_with_blocks(4);
  std::set<std::string> plans;
  std::set<std::uint64_t> attempts;
  std::set<std::uint64_t> memoised;
  for (const unsigned threads : {1u, 2u, 4u}) {
    RunContext context;
    context.threads = threads;
    RunResult result = run(assembly, fake::setup(fake::push, make()), RunOptions{}, context);
    EXPECT_EQ(result.outcome, Outcome::solved);
    for (auto& step : result.plan.disassembly) step.seconds = 0;
    for (auto& part : result.plan.unsolved) part.seconds = 0;
    plans.insert(to_json(result.plan));
    attempts.insert(result.counts.attempts);
    memoised.insert(result.counts.memoised);
  }
  EXPECT_EQ(plans.size(), 1u);
  EXPECT_EQ(attempts.size(), 1u);
  EXPECT_EQ(memoised.size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(Registered, SequencePlannerContract, testing::ValuesIn(ids(PluginKind::sequence_planner)),
                         test_name);

}  // namespace
}  // namespace dismantle
