// Which path searches are made, on machines without geometry.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "blocking/blocking.h"
#include "dismantle/testing/fake_oracle.h"

namespace dismantle {
namespace {

TEST(BlockingSearches, DoesNotRepeatSearchesWhileTheirBlockersStand) {
  // Without geometry every path is searched for. The chain is opposite to the order of trying. A part whose blocker is
  // still there is not asked for again at the same depth.
  FakeMachine machine(12);
  for (PartId k = 0; k + 1 < 12; ++k) machine.before[k] = {k + 1};
  BlockingParameters params;
  params.order = PartOrder::as_given;
  Blocking planner(params);
  const FakeRun run = run_on(planner, machine, seeded(1));
  expect_lawful(run, machine);
  EXPECT_EQ(run.result.outcome, Outcome::solved);
  EXPECT_LE(run.asked.size(), 2 * machine.size()) << "once without success, once when the blocker has left";
  EXPECT_GT(run.result.counts.at("postponed"), 0);
}

/// What the planner asks about a machine, and how it ends.
struct Asked {
  std::vector<Attempt> questions;
  Outcome outcome;
};

Asked run_blocking(const FakeMachine& machine) {
  FakeOracle oracle(machine);
  Notes notes;
  RunContext context = seeded(1);
  const Assembly assembly = machine.assembly();
  const Constraints constraints;
  const Objective objective;
  Blocking planner(BlockingParameters{});
  const Outcome end =
      planner.plan({assembly, whole_assembly(assembly), constraints, objective}, oracle, notes, context).outcome;
  return {oracle.questions, end};
}

/// The oracle may resume the last search of the same part: that search had at least the same obstacles, or is the same
/// question.
TEST(BlockingSearches, EachMayResumeTheLastOfThePart) {
  Rng rng(5);
  std::size_t again = 0;
  for (int round = 0; round < 20; ++round) {
    const FakeMachine machine = FakeMachine::random(10, 0.3, 3, rng);
    const Asked run = run_blocking(machine);
    EXPECT_EQ(run.outcome, Outcome::solved);
    std::map<PartId, std::size_t> last;
    for (std::size_t k = 0; k < run.questions.size(); ++k) {
      const Attempt& now = run.questions[k];
      EXPECT_TRUE(now.resume);
      const PartId part = now.moving[0].part;
      if (const auto before = last.find(part); before != last.end()) {
        const Attempt& then = run.questions[before->second];
        EXPECT_LE(now.fixed.size(), then.fixed.size());
        for (const PlacedPart& s : now.fixed)
          EXPECT_TRUE(
              std::any_of(then.fixed.begin(), then.fixed.end(), [&](const PlacedPart& t) { return t.part == s.part; }));
        ++again;
      }
      last[part] = k;
    }
  }
  EXPECT_GT(again, 50U);
}

/// Either part of a pair may be far easier to move than the other: neither is searched for without a limit before both
/// were searched for to a small depth.
TEST(BlockingSearches, OfAPairBothPartsComeBeforeASearchWithoutALimit) {
  FakeMachine machine(2);
  machine.before[0] = {1};
  machine.before[1] = {0};
  std::map<PartId, unsigned> limited;
  bool unlimited = false;
  for (const Attempt& asked : run_blocking(machine).questions) {
    if (asked.max_depth == 0) {
      unlimited = true;
      EXPECT_EQ(limited.size(), 2U);
    } else if (asked.max_depth > 1) {
      limited[asked.moving[0].part] = asked.max_depth;
    }
  }
  EXPECT_TRUE(unlimited);
}

}  // namespace
}  // namespace dismantle
