// Searches for ways on machines without geometry: which are made, and from where they go on.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "blocking/blocking.h"
#include "dismantle/testing/fake_oracle.h"

namespace dismantle {
namespace {

TEST(BlockingSearches, DoesNotRepeatSearchesWhileTheirBlockersStand) {
  // Without geometry all ways are searched for. A chain against the order of trying: whoever is blocked by one that is
  // still there is not asked again at the same depth.
  FakeMachine machine(12);
  for (PartId k = 0; k + 1 < 12; ++k) machine.before[k] = {k + 1};
  BlockingParams params;
  params.order = PartOrder::as_given;
  Blocking planner(params);
  const FakeRun run = run_on(planner, machine, seeded(1));
  expect_lawful(run, machine);
  EXPECT_EQ(run.result.outcome, Outcome::solved);
  EXPECT_LE(run.asked.size(), 2 * machine.size()) << "once in vain, once when the blocker has left";
  EXPECT_GT(run.result.counts.at("postponed"), 0);
}

/// Each search goes on from the last one of the same part, which had at least the parts in its way that it has; or it
/// is the very question that was asked before.
TEST(BlockingSearches, GoesOnFromTheLastSearchOfAPart) {
  Rng rng(5);
  std::size_t resumed = 0;
  for (int round = 0; round < 20; ++round) {
    const FakeMachine machine = FakeMachine::random(10, 0.3, 3, rng);
    FakeOracle oracle(machine);
    Notes notes;
    RunContext context = seeded(1);
    const Assembly assembly = machine.assembly();
    Blocking planner(BlockingParams{});
    EXPECT_EQ(planner.plan(assembly, oracle, notes, context).outcome, Outcome::solved);
    std::map<PartId, std::size_t> last;
    for (std::size_t k = 0; k < oracle.questions.size(); ++k) {
      const Attempt& now = oracle.questions[k];
      const PartId part = now.moving[0].part;
      const auto before = last.find(part);
      EXPECT_EQ(now.after != nullptr, before != last.end());
      if (now.after != nullptr && before != last.end()) {
        const Attempt& then = oracle.questions[before->second];
        const bool once_more = now.max_depth == then.max_depth && now.still.size() == then.still.size();
        EXPECT_EQ(now.after, once_more ? then.after : oracle.answers[before->second]);
        EXPECT_LE(now.still.size(), then.still.size());
        for (const PlacedPart& s : now.still)
          EXPECT_TRUE(
              std::any_of(then.still.begin(), then.still.end(), [&](const PlacedPart& t) { return t.part == s.part; }));
        ++resumed;
      }
      last[part] = k;
    }
  }
  EXPECT_GT(resumed, 50U);
}

}  // namespace
}  // namespace dismantle
