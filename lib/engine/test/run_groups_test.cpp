// What runs record: groups, intermediate placements, and nothing that the oracle did not accept.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "dismantle/errors.h"
#include "dismantle/testing/run_rig.h"
#include "dismantle/verification/check_plan.h"
#include "precedence.h"

namespace dismantle {
namespace {

using fake::Custom;
using fake::leave;
using fake::Steps;

TEST(Run, NoStepIsBookedThatTheOracleDidNotAllow) {
  AttemptResult forged;
  const fake::RuleChecker accepts = fake::accept_all();
  forged.result.solve(*accepts.check({{Pose{}}, {Pose{}}}).verified, 1);
  const std::vector<std::pair<std::string, Steps>> cheats{
      {"own answer",
       [&](const Assembly&, PathOracle&, SequenceObserver& observer, RunContext&) {
         observer.removed({{1}, &forged}, 2);
         return SequenceResult{};
       }},
      {"failed attempt",
       [](const Assembly& a, PathOracle& oracle, SequenceObserver& observer, RunContext& c) {
         observer.removed({{1}, &oracle.attempt(leave(a, 1), c)}, 2);
         return SequenceResult{};
       }},
      {"found with a part absent",
       [](const Assembly& a, PathOracle& oracle, SequenceObserver& observer, RunContext& c) {
         Attempt without = leave(a, 1);
         without.fixed.pop_back();
         observer.removed({{1}, &oracle.attempt(without, c)}, 2);
         return SequenceResult{};
       }},
      {"found for another part",
       [](const Assembly& a, PathOracle& oracle, SequenceObserver& observer, RunContext& c) {
         observer.removed({{1}, &oracle.attempt(leave(a, 2), c)}, 2);
         return SequenceResult{};
       }},
      {"unknown part",
       [](const Assembly& a, PathOracle& oracle, SequenceObserver& observer, RunContext& c) {
         observer.removed({{9}, &oracle.attempt(leave(a, 2), c)}, 2);
         return SequenceResult{};
       }},
      {"swallows the error",
       [&](const Assembly& a, PathOracle& oracle, SequenceObserver& observer, RunContext& c) {
         try {
           observer.removed({{1}, &forged}, 2);
         } catch (const std::exception&) {  // the runner has noticed all the same
         }
         SequenceResult result;
         result.outcome = Outcome::solved;
         result.removals.push_back({{1}, &oracle.attempt(leave(a, 2), c)});
         return result;
       }},
      {"claims success",
       [](const Assembly&, PathOracle&, SequenceObserver&, RunContext&) {
         SequenceResult result;
         result.outcome = Outcome::solved;
         return result;
       }},
  };
  for (const auto& [name, steps] : cheats) {
    RunContext context;
    const RunResult r =
        run(fake::tube_with_blocks(2), fake::setup(fake::push, std::make_shared<Custom>(steps)), RunOptions{}, context);
    EXPECT_EQ(r.outcome, Outcome::crashed) << name;
    EXPECT_TRUE(r.plan.disassembly.empty()) << name;
    EXPECT_EQ(r.plan.unsolved.size(), 3u) << name;
  }
}

TEST(Run, AGroupComesOutWholeAndIsTakenApartLater) {
  const auto lift = [](const PathQuery& q, RunContext&) { return fake::shown(q, fake::straight(q.scene, {0, 0, 30})); };
  const auto in_groups = [](const Assembly&, PathOracle& oracle, SequenceObserver& observer, RunContext& c) {
    Attempt both;
    both.moving = {{1, Pose{}}, {2, Pose{}}};
    both.fixed = {{0, Pose{}}};
    SequenceResult result;
    const AttemptResult& up = oracle.attempt(both, c);
    result.removals.push_back({{1, 2}, &up});
    observer.removed(result.removals.back(), 1);
    Attempt apart;
    apart.moving = {{2, up.result.path()->poses().back()[1]}};
    apart.fixed = {{1, up.result.path()->poses().back()[0]}};
    result.removals.push_back({{2}, &oracle.attempt(apart, c)});
    observer.removed(result.removals.back(), 1);
    result.outcome = Outcome::solved;
    result.remaining = {0};
    return result;
  };
  RunContext context;
  const RunResult r =
      run(fake::tube_with_blocks(2), fake::setup(lift, std::make_shared<Custom>(in_groups)), RunOptions{}, context);
  EXPECT_EQ(r.outcome, Outcome::solved);
  ASSERT_EQ(r.plan.disassembly.size(), 2u);
  EXPECT_EQ(r.plan.disassembly[0].separates, (std::vector<std::vector<std::string>>{{"block1", "block2"}}));
  EXPECT_EQ(r.plan.remaining, (std::vector<std::string>{"tube"}));
  const auto& first = r.plan.disassembly[0].moves[1].poses;
  const auto& second = r.plan.disassembly[1].moves[0].poses;
  EXPECT_EQ(first.back().t, second.front().t);  // rule (a)
}

TEST(Run, OneLeavesAndTheOtherStaysWhereItWasMoved) {
  for (const bool honest : {true, false}) {
    const auto at_once = [&](const Assembly&, PathOracle& oracle, SequenceObserver& observer, RunContext&) {
      SequenceResult result;
      Attempt both;
      both.moving = {{1, Pose{}}, {2, Pose{}}};
      both.fixed = {{0, Pose{}}};
      both.goal.any_of = {1, 2};
      Path motion = fake::straight({both.moving, both.fixed}, {0, 0, 30});
      motion[1][0].t.z() = 0.5;
      RunContext c;
      const AttemptResult& r = oracle.propose(both, motion, c);
      result.removals.push_back({{1, 2}, &r});
      observer.removed(result.removals.back(), 2);
      Attempt last;
      last.moving = {{1, honest ? r.result.path()->poses().back()[0] : Pose{}}};
      last.fixed = {{0, Pose{}}};
      result.removals.push_back({{1}, &oracle.propose(last, fake::straight({last.moving, {}}, {0, 0, 30}), c)});
      observer.removed(result.removals.back(), 1);
      result.outcome = Outcome::solved;
      result.remaining = {0};
      return result;
    };
    RunContext context;
    const RunResult r = run(fake::tube_with_blocks(2), fake::setup(fake::push, std::make_shared<Custom>(at_once)),
                            RunOptions{}, context);
    ASSERT_EQ(r.plan.disassembly.size(), honest ? 2u : 1u) << "the other is not where it was";
    const PlanStep& first = r.plan.disassembly[0];
    EXPECT_EQ(first.moves.size(), 2u);
    EXPECT_EQ(first.separates, (std::vector<std::vector<std::string>>{{"block2"}}));
    if (!honest) continue;
    EXPECT_EQ(r.outcome, Outcome::solved);
    EXPECT_EQ(r.plan.status, PlanStatus::complete);
    EXPECT_EQ(r.plan.disassembly[1].moves[0].poses.front().t.z(), 0.5);
    EXPECT_EQ(r.plan.disassembly[1].after, std::vector<unsigned>{1});
    EXPECT_EQ(r.precedence, (std::vector<std::pair<std::string, std::string>>{{"block2", "block1"}}));
    const PlanCheck check = check_plan(r.plan, fake::tube_with_blocks(2), VerifyOptions{}, context);
    EXPECT_TRUE(check.valid && check.complete);
    Plan lies = r.plan;
    lies.disassembly[0].separates[0][0] = "block1";
    EXPECT_FALSE(check_plan(lies, fake::tube_with_blocks(2), VerifyOptions{}, context).valid);
  }
}

/// Lifts blocks in several moves, in the order given; the last move of a block separates it.
RunResult in_bits(const std::vector<PartId>& order) {
  const auto bits = [&](const Assembly& assembly, PathOracle& oracle, SequenceObserver& observer, RunContext& c) {
    SequenceResult result;
    std::vector<Pose> at(assembly.parts.size());
    std::vector<bool> gone(assembly.parts.size(), false);
    for (std::size_t k = 0; k < order.size(); ++k) {
      const PartId part = order[k];
      const bool last = std::count(order.begin() + static_cast<std::ptrdiff_t>(k), order.end(), part) == 1;
      Attempt a;
      a.goal.placement = !last;
      a.moving = {{part, at[part]}};
      for (const auto& p : assembly.parts)
        if (p.id != part && !gone[p.id]) a.fixed.push_back({p.id, at[p.id]});
      const Path motion = fake::straight({a.moving, a.fixed}, {0, 0, last ? 30 : 0.25});
      const AttemptResult& r = oracle.propose(a, motion, c);
      at[part] = r.result.path()->poses().back()[0];
      gone[part] = last;
      result.removals.push_back({{part}, &r});
      observer.removed(result.removals.back(), 1);
    }
    result.outcome = Outcome::solved;
    return result;
  };
  RunContext context;
  return run(fake::tube_with_blocks(2), fake::setup(fake::push, std::make_shared<Custom>(bits)), RunOptions{}, context);
}

/// What a step needs is determined after a time limit, too; a step that was not looked at does not say that it needs
/// all others.
TEST(Run, AStepNeedsOnlyWhatIsInItsWayAlsoWhenTimeIsUp) {
  const Assembly assembly = fake::tube_with_blocks(3);
  for (const bool cancelled : {false, true}) {
    RunContext context;
    context.deadline = Deadline::after_seconds(cancelled ? 1000 : 0);
    Disassembly done(assembly.parts.size());
    for (const PartId part : {3, 2, 1}) {
      DisassemblyStep step;
      step.parts = {part};
      step.path = std::make_shared<const Path>(Path{{Pose{}}, {Pose{{0, 0, 30}, Pose{}.q}}});
      done.add(std::move(step));
    }
    if (cancelled) context.cancel.cancel();
    const Verifier verifier(assembly, VerifyOptions{});
    const auto needed = needed_steps(done, assembly, verifier, context);
    ASSERT_EQ(needed.size(), cancelled ? 1u : 3u);
    EXPECT_EQ(needed[0], std::vector<std::size_t>{});
    if (cancelled) continue;
    EXPECT_EQ(needed[1], std::vector<std::size_t>{0});
    EXPECT_EQ(needed[2], std::vector<std::size_t>{1});
  }
}

TEST(Run, WhatMovesOnFromPartWayIsOneStep) {
  const RunResult r = in_bits({2, 2, 2, 1});
  EXPECT_EQ(r.outcome, Outcome::solved);
  ASSERT_EQ(r.plan.disassembly.size(), 2u);
  const PlanStep& step = r.plan.disassembly[0];
  EXPECT_EQ(step.separates, (std::vector<std::vector<std::string>>{{"block2"}}));
  EXPECT_EQ(step.moves[0].poses.front().t.z(), 0);
  EXPECT_EQ(step.moves[0].poses.back().t.z(), 30.5);
  for (std::size_t k = 1; k < step.moves[0].poses.size(); ++k)
    EXPECT_GT(step.moves[0].poses[k].t.z(), step.moves[0].poses[k - 1].t.z()) << "no instant twice";
  EXPECT_EQ(r.plan.disassembly[1].step, 2u);
  EXPECT_EQ(r.plan.disassembly[1].after, std::vector<unsigned>{1});
  ASSERT_EQ(r.plan.assembly_steps.size(), 2u);
  EXPECT_EQ(r.plan.assembly_steps[1].moves[0].part, "block2");
  RunContext context;
  EXPECT_TRUE(check_plan(r.plan, fake::tube_with_blocks(2), VerifyOptions{}, context).valid);
}

TEST(Run, WhatMovesInBetweenKeepsStepsApart) {
  const RunResult r = in_bits({2, 2, 1, 2, 1});
  EXPECT_EQ(r.outcome, Outcome::solved);
  ASSERT_EQ(r.plan.disassembly.size(), 4u);
  EXPECT_TRUE(r.plan.disassembly[0].separates.empty());
  EXPECT_TRUE(r.plan.disassembly[1].separates.empty());
  EXPECT_EQ(r.plan.disassembly[0].moves[0].poses.back().t.z(), 0.5);
  EXPECT_EQ(r.plan.disassembly[2].separates.size(), 1u);
  RunContext context;
  EXPECT_TRUE(check_plan(r.plan, fake::tube_with_blocks(2), VerifyOptions{}, context).valid);
}

}  // namespace
}  // namespace dismantle
