// Parts are prepared for simulation once, when the first search is made.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <stdexcept>

#include "dismantle/engine/run.h"
#include "dismantle/errors.h"
#include "dismantle/executor.h"
#include "dismantle/testing/run_rig.h"

namespace dismantle {
namespace {

using fake::Custom;
using fake::leave;

/// A set-up that counts how often parts are prepared.
PlanningSetup counting(std::atomic<int>& prepared, std::shared_ptr<SequencePlanner> planner) {
  PlanningSetup setup = fake::setup(fake::push_blocks, std::move(planner));
  auto simulator = std::make_shared<fake::Physics>();
  simulator->on_prepare = [&prepared](RunContext&) { ++prepared; };
  setup.simulator = simulator;
  return setup;
}

TEST(DeferredSimulator, IsNotAskedWhereNothingIsSearchedFor) {
  const auto propose_all = [](const Assembly& assembly, PathOracle& oracle, SequenceObserver& observer,
                              RunContext& context) {
    Attempt attempt = leave(assembly, 1);
    for (PartId part = 1; part < assembly.parts.size(); ++part) {
      attempt = leave(assembly, part);
      std::erase_if(attempt.fixed, [part](const PlacedPart& p) { return p.part > 0 && p.part < part; });
      const Path path = fake::straight({attempt.moving, attempt.fixed}, {0, 30, 0});
      const AttemptResult& answer = oracle.propose(attempt, path, context);
      observer.removed({{part}, &answer}, 0);
    }
    SequenceResult result;
    result.outcome = Outcome::solved;
    return result;
  };
  std::atomic<int> prepared = 0;
  RunContext context;
  const RunResult r = run(fake::row(4), counting(prepared, std::make_shared<Custom>(propose_all)), {}, context);
  EXPECT_EQ(r.outcome, Outcome::solved);
  EXPECT_EQ(r.plan.disassembly.size(), 3u);
  EXPECT_EQ(prepared, 0);
  EXPECT_EQ(r.prepare_seconds, 0);
}

TEST(DeferredSimulator, PreparesOnceForAllThreads) {
  const auto ask_all = [](const Assembly& assembly, PathOracle& oracle, SequenceObserver&, RunContext& context) {
    std::vector<Attempt> attempts;
    for (PartId part = 1; part < assembly.parts.size(); ++part) attempts.push_back(leave(assembly, part));
    oracle.prefetch(attempts, context);
    for (const Attempt& a : attempts) (void)oracle.attempt(a, context);
    SequenceResult result;
    result.outcome = Outcome::exhausted;
    return result;
  };
  for (const unsigned threads : {1U, 4U}) {
    std::atomic<int> prepared = 0;
    RunContext context;
    context.threads = threads;
    const RunResult r =
        run(fake::tube_with_blocks(6), counting(prepared, std::make_shared<Custom>(ask_all)), {}, context);
    EXPECT_EQ(r.counts.attempts, 6u);
    EXPECT_EQ(prepared, 1);
  }
}

/// The error ends the run at the first search, even if the sequence planner ignores it; earlier steps are in the plan
/// that was passed on.
TEST(DeferredSimulator, AFailureEndsTheRun) {
  int asked = 0;
  const auto persistent = [&asked](const Assembly& assembly, PathOracle& oracle, SequenceObserver&,
                                   RunContext& context) {
    for (int round = 0; round < 3; ++round) {
      try {
        (void)oracle.attempt(leave(assembly, 1), context);
      } catch (const InputError&) {
        ++asked;
      }
    }
    return SequenceResult{};
  };
  PlanningSetup setup = fake::setup(fake::push_blocks, std::make_shared<Custom>(persistent));
  auto simulator = std::make_shared<fake::Physics>();
  simulator->on_prepare = [](RunContext&) { throw InputError("block1", "too thin"); };
  setup.simulator = simulator;
  RunContext context;
  EXPECT_THROW(run(fake::row(2), setup, {}, context), InputError);
  EXPECT_EQ(asked, 3);
  EXPECT_FALSE(context.should_stop()) << "the caller's";
}

}  // namespace
}  // namespace dismantle
