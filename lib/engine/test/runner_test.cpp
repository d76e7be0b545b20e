#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "dismantle/engine/run.h"
#include "dismantle/errors.h"
#include "dismantle/testing/fake_prover.h"
#include "dismantle/testing/run_rig.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {
namespace {

using fake::Custom;
using fake::InTurn;
using fake::leave;
using fake::push_blocks;
using fake::run_in_turn;
using fake::text_without_times;
using Pairs = std::vector<std::pair<std::string, std::string>>;

TEST(Run, TakesATubeApartFromTheTop) {
  const Assembly assembly = fake::tube_with_blocks(3);
  RunContext context;
  const RunResult r = run(assembly, fake::setup(push_blocks, std::make_shared<InTurn>()), RunOptions{}, context);
  EXPECT_EQ(r.outcome, Outcome::solved);
  const Plan& plan = r.plan;
  EXPECT_EQ(plan.status, PlanStatus::complete);
  EXPECT_TRUE(plan.unsolved.empty());
  EXPECT_EQ(plan.remaining.size(), 1u);
  ASSERT_EQ(plan.disassembly.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const PlanStep& step = plan.disassembly[i];
    EXPECT_EQ(step.step, i + 1);
    ASSERT_EQ(step.moves.size(), 1u);
    EXPECT_GE(step.moves[0].poses.size(), 2u);
    EXPECT_EQ(step.separates, (std::vector<std::vector<std::string>>{{step.moves[0].part}}));
    EXPECT_EQ(step.planner, "scripted");
    EXPECT_EQ(step.depth, 1u);
    EXPECT_LE(step.max_penetration, 0.01);
  }
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(plan.disassembly[i].moves[0].part, "block" + std::to_string(3 - i));
  EXPECT_EQ(plan.remaining, (std::vector<std::string>{"tube"}));
  EXPECT_EQ(plan.assembly.parts.size(), 4u);
}

TEST(Run, AssemblyIsTheDisassemblyBackwards) {
  const Plan plan = run_in_turn(fake::tube_with_blocks(3)).plan;
  const std::size_t n = plan.disassembly.size();
  ASSERT_EQ(plan.assembly_steps.size(), n);
  for (std::size_t i = 0; i < n; ++i) {
    const PlanStep& there = plan.disassembly[n - 1 - i];
    const PlanStep& back = plan.assembly_steps[i];
    EXPECT_EQ(back.step, i + 1);
    ASSERT_EQ(back.moves.size(), there.moves.size());
    for (std::size_t m = 0; m < there.moves.size(); ++m) {
      EXPECT_EQ(back.moves[m].part, there.moves[m].part);
      const std::size_t k = there.moves[m].poses.size();
      ASSERT_EQ(back.moves[m].poses.size(), k);
      for (std::size_t j = 0; j < k; ++j) {
        EXPECT_EQ(back.moves[m].poses[j].t, there.moves[m].poses[k - 1 - j].t);
        EXPECT_EQ(back.moves[m].poses[j].q.coeffs(), there.moves[m].poses[k - 1 - j].q.coeffs());
      }
    }
  }
}

TEST(Run, PosesAreInInputUnits) {
  Assembly assembly = fake::tube_with_blocks(1);
  assembly.normalization.scale = 0.5;  // an internal unit is two input units
  assembly.normalization.center = {100, 0, 0};
  const Plan plan = run_in_turn(assembly).plan;
  ASSERT_EQ(plan.disassembly.size(), 1u);
  const Pose& end = plan.disassembly[0].moves[0].poses.back();
  EXPECT_NEAR(end.t.norm(), 60, 1e-9);
  EXPECT_EQ(plan.assembly.scale, 0.5);
  EXPECT_EQ(plan.assembly.center, Eigen::Vector3d(100, 0, 0));
}

TEST(Run, PrecedenceIsWhatTheWaysNeedAndNoMore) {
  const Assembly assembly = fake::tube_with_blocks(4);
  RunContext context;
  const RunResult r = run(assembly, fake::setup(push_blocks, std::make_shared<InTurn>()), RunOptions{}, context);
  ASSERT_EQ(r.plan.disassembly.size(), 4u);
  // Each block needs the next one gone; what follows from that is left out, and no step waits for the tube.
  EXPECT_EQ(r.precedence, (Pairs{{"block4", "block3"}, {"block3", "block2"}, {"block2", "block1"}}));
  for (const PlanStep& step : r.plan.disassembly) EXPECT_EQ(step.layer, step.step);
}

TEST(Run, SameSeedSamePlanOnAnyNumberOfThreads) {
  const Assembly assembly = fake::tube_with_blocks(4);
  std::set<std::string> plans;
  std::set<std::uint64_t> attempts;
  std::set<Pairs> precedences;
  for (const unsigned threads : {1u, 1u, 2u, 4u}) {
    RunContext context;
    context.threads = threads;
    const RunResult r = run_in_turn(assembly, context);
    plans.insert(text_without_times(r.plan));
    attempts.insert(r.counts.attempts);
    precedences.insert(r.precedence);
  }
  EXPECT_EQ(plans.size(), 1u);
  EXPECT_EQ(attempts.size(), 1u);
  EXPECT_EQ(precedences.size(), 1u);
}

TEST(Run, TheSeedIsThatOfTheOptions) {
  const auto marks = [](const PathQuery& q, RunContext& c) {
    const double draw = c.rng.uniform();
    return fake::shown(q, fake::straight(q.scene, {0, 0, 30 + draw}));
  };
  const Assembly assembly = fake::tube_with_blocks(2);
  std::set<std::string> plans;
  for (const std::uint64_t seed : {1, 2, 1}) {
    RunContext context;
    context.rng = Rng(99 + plans.size());  // does not matter
    RunOptions options;
    options.seed = seed;
    const RunResult r = run(assembly, fake::setup(marks, std::make_shared<InTurn>()), options, context);
    EXPECT_EQ(r.plan.seed, seed);
    plans.insert(text_without_times(r.plan));
  }
  EXPECT_EQ(plans.size(), 2u);
}

TEST(Run, EachStepIsHandedOnAsItIsDone) {
  std::vector<std::size_t> seen;
  RunContext context;
  const Assembly assembly = fake::tube_with_blocks(3);
  const auto keep = [&](const Disassembly& so_far, const DisassemblyStep& newest) {
    EXPECT_EQ(&newest, &so_far.steps().back());
    const Plan plan = plan_of(so_far, assembly, RunOptions{});
    seen.push_back(plan.disassembly.size());
    EXPECT_EQ(plan.assembly_steps.size(), plan.disassembly.size());
    EXPECT_EQ(plan.status == PlanStatus::complete, plan.disassembly.size() == 3);
    if (seen.size() == 2) throw std::runtime_error("disk full");  // must not stop the run
  };
  std::vector<std::string> errors;
  context.on_log = [&](LogLevel level, std::string_view text) {
    if (level == LogLevel::error) errors.emplace_back(text);
  };
  const RunResult r =
      run(assembly, fake::setup(fake::push, std::make_shared<InTurn>()), RunOptions{}, context, keep);
  EXPECT_EQ(r.outcome, Outcome::solved);
  EXPECT_EQ(seen, (std::vector<std::size_t>{1, 2, 3}));
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("disk full"), std::string::npos);
}

TEST(Run, CancellationKeepsTheStepsDone) {
  for (const unsigned threads : {1u, 3u}) {
    RunContext context;
    context.threads = threads;
    const auto stop_after_two = [&](const Disassembly& so_far, const DisassemblyStep& /*newest*/) {
      if (so_far.steps().size() == 2) context.cancel.cancel();
    };
    const RunResult r = run(fake::tube_with_blocks(4), fake::setup(fake::push, std::make_shared<InTurn>()),
                            RunOptions{}, context, stop_after_two);
    EXPECT_EQ(r.plan.disassembly.size(), 2u);
    EXPECT_EQ(r.plan.status, PlanStatus::partial);
    EXPECT_EQ(r.plan.remaining.size(), 3u);
    EXPECT_EQ(r.plan.unsolved.size(), 3u);
  }
}

TEST(Run, CancelledBeforeItBegan) {
  RunContext context;
  context.cancel.cancel();
  const RunResult r = run_in_turn(fake::tube_with_blocks(2), context);
  EXPECT_EQ(r.outcome, Outcome::cancelled);
  EXPECT_EQ(r.plan.remaining.size(), 3u);
  for (const auto& u : r.plan.unsolved) EXPECT_EQ(u.outcome, Outcome::cancelled);
  context = {};
  context.deadline = Deadline::after_seconds(0);
  EXPECT_EQ(run_in_turn(fake::tube_with_blocks(2), context).outcome, Outcome::timeout);
}

TEST(Run, APlateNeverLeavesAClosedBox) {
  RunOptions options;
  options.only_part = "plate";
  RunContext context;
  const RunResult r = run(fake::closed_box(), fake::setup(fake::push), options, context);
  EXPECT_EQ(r.outcome, Outcome::exhausted);
  EXPECT_EQ(r.plan.status, PlanStatus::partial);
  EXPECT_TRUE(r.plan.disassembly.empty());
  ASSERT_EQ(r.plan.unsolved.size(), 1u);
  EXPECT_EQ(r.plan.unsolved[0].blocked_by, (std::vector<std::string>{"box"}));
}

/// Provers are not asked about parts that leave with one action, but about those that do not.
TEST(Run, OnePartIsSearchedForBeforeItIsProvedHeld) {
  for (const auto& [assembly, part, solved] :
       {std::tuple(fake::tube_with_blocks(1), "block1", true), std::tuple(fake::closed_box(), "plate", false)}) {
    unsigned asked = 0;
    PlanningSetup setup = fake::setup([solved = solved](const PathQuery& query, RunContext&) {
      const Path path = fake::straight(query.scene, {0, 0, 30});
      if (solved) return fake::shown(query, path);
      return PathResult::failure(query.budget.max_depth > 0 ? Outcome::depth_limit : Outcome::exhausted);
    });
    setup.provers = {
        fake::prover("counting", {.effort = ProofEffort::low}, [&](const SeparationQuery&, const RunContext&) {
          ++asked;
          return std::optional<Certificate>();
        })};
    RunOptions options;
    options.only_part = part;
    RunContext context;
    const RunResult r = run(assembly, setup, options, context);
    EXPECT_EQ(is_success(r.outcome), solved) << part;
    EXPECT_EQ(asked > 0, !solved) << part;
  }
}

TEST(Run, OnePartOnly) {
  RunOptions options;
  options.only_part = "block2";
  PlanningSetup parts = fake::setup(fake::push);  // no sequence planner needed
  RunContext context;
  const RunResult out = run(fake::tube_with_blocks(2), parts, options, context);
  EXPECT_EQ(out.outcome, Outcome::solved);
  ASSERT_EQ(out.plan.disassembly.size(), 1u);
  EXPECT_EQ(out.plan.disassembly[0].moves[0].part, "block2");
  EXPECT_EQ(out.plan.remaining, (std::vector<std::string>{"tube", "block1"}));
  EXPECT_TRUE(out.plan.unsolved.empty());
  options.only_part = "block1";
  const RunResult in = run(fake::tube_with_blocks(2), parts, options, context);
  EXPECT_EQ(in.outcome, Outcome::exhausted);
  ASSERT_EQ(in.plan.unsolved.size(), 1u);
  EXPECT_EQ(in.plan.unsolved[0].part, "block1");
  options.only_part = "no such part";
  EXPECT_THROW(run(fake::tube_with_blocks(2), parts, options, context), InputError);
}

TEST(Run, AFailingSequencePlannerLosesNoStep) {
  const auto one_then_throw = [](const Assembly& assembly, PathOracle& oracle, SequenceObserver& observer,
                                 RunContext& context) -> SequenceResult {
    const AttemptResult& r = oracle.attempt(leave(assembly, 2), context);
    observer.removed({{2}, &r}, 2);
    throw std::runtime_error("ran out of ideas");
  };
  RunContext context;
  const RunResult r = run(fake::tube_with_blocks(2), fake::setup(fake::push, std::make_shared<Custom>(one_then_throw)),
                          RunOptions{}, context);
  EXPECT_EQ(r.outcome, Outcome::crashed);
  EXPECT_EQ(r.plan.disassembly.size(), 1u);
  EXPECT_EQ(r.plan.unsolved.size(), 2u);
}

TEST(Run, ASimulatorThatCannotPrepare) {
  PlanningSetup parts = fake::setup(fake::push, std::make_shared<InTurn>());
  auto simulator = std::make_shared<fake::Physics>();
  parts.simulator = simulator;
  RunContext context;
  simulator->on_prepare = [](RunContext&) { throw std::runtime_error("out of memory"); };
  EXPECT_THROW(run(fake::row(2), parts, RunOptions{}, context), PluginError);
  simulator->on_prepare = [](RunContext&) { throw InputError("block1", "too thin"); };
  EXPECT_THROW(run(fake::row(2), parts, RunOptions{}, context), InputError);
  simulator->on_prepare = [](RunContext& c) {
    c.cancel.cancel();
    throw std::runtime_error("stopped");
  };
  EXPECT_EQ(run(fake::row(2), parts, RunOptions{}, context).outcome, Outcome::cancelled);
}

TEST(Run, OnePartIsDone) {
  const RunResult r = run_in_turn(fake::row(1));
  EXPECT_EQ(r.outcome, Outcome::solved);
  EXPECT_TRUE(r.plan.disassembly.empty());
  EXPECT_EQ(r.plan.remaining.size(), 1u);
  EXPECT_THROW(run_in_turn(Assembly{}), InputError);
}

}  // namespace
}  // namespace dismantle
