#include "dismantle/runner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "dismantle/errors.h"
#include "dismantle/plan/check_plan.h"
#include "fake_planning.h"

namespace dismantle {
namespace {

using fake::leave;
using Pairs = std::vector<std::pair<std::string, std::string>>;

/// Tries all parts left in turn until none leaves; hints all it knows.
class InTurn : public SequencePlanner {
 public:
  SequenceResult plan(const Assembly& assembly, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override {
    SequenceResult result;
    std::vector<PartId> left;
    for (const auto& p : assembly.parts) left.push_back(p.id);
    for (bool removed = true; removed && left.size() > 1;) {
      removed = false;
      result.unsolved.clear();
      std::vector<Attempt> round;
      for (const PartId id : left) round.push_back(question(left, id));
      oracle.prefetch(round, context);
      for (std::size_t i = 0; i < left.size() && !removed; ++i) {
        const AttemptResult& r = oracle.attempt(question(left, left[i]), context);
        if (is_success(r.result.outcome)) {
          removed = true;
          result.removals.push_back({{left[i]}, &r});
          left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
          observer.removed(result.removals.back(), left.size());
        } else {
          result.unsolved.push_back({left[i], r.result.outcome, r.result.blocked_by, {}, r.result.message});
        }
      }
    }
    result.remaining = left;
    result.outcome = left.size() <= 1 ? Outcome::solved : Outcome::exhausted;
    if (left.size() <= 1) result.unsolved.clear();
    return result;
  }

  static Attempt question(const std::vector<PartId>& left, PartId part) {
    Attempt a;
    a.moving.push_back({part, Pose{}});
    for (const PartId id : left)
      if (id != part) a.still.push_back({id, Pose{}});
    return a;
  }
};

/// The tube could go first, downwards: here it stands on a table.
PathResult push_blocks(const PathQuery& query, RunContext& context) {
  return query.cast.moving[0].part == 0 ? fake::outcome(Outcome::exhausted) : fake::push(query, context);
}

using Steps = std::function<SequenceResult(const Assembly&, PathOracle&, SequenceObserver&, RunContext&)>;
class Custom final : public SequencePlanner {
 public:
  explicit Custom(Steps steps) : steps_(std::move(steps)) {}
  SequenceResult plan(const Assembly& a, PathOracle& o, SequenceObserver& s, RunContext& c) override {
    return steps_(a, o, s, c);
  }

 private:
  Steps steps_;
};

RunResult run_in_turn(const Assembly& assembly, RunContext context = {}, const RunOptions& options = {}) {
  return run(assembly, fake::ingredients(fake::push, std::make_shared<InTurn>()), options, context);
}

std::string text_without_times(Plan plan) {
  for (auto& step : plan.disassembly) step.seconds = 0;
  return to_json(plan);
}

TEST(Run, TakesATubeApartFromTheTop) {
  const Assembly assembly = fake::tube_with_blocks(3);
  RunContext context;
  const RunResult r = run(assembly, fake::ingredients(push_blocks, std::make_shared<InTurn>()), RunOptions{}, context);
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
  const RunResult r = run(assembly, fake::ingredients(push_blocks, std::make_shared<InTurn>()), RunOptions{}, context);
  ASSERT_EQ(r.plan.disassembly.size(), 4u);
  // Each block needs the next one gone; what follows from that is left out, and nobody waits for the tube.
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
    PathResult r;
    r.path = fake::straight(q.cast, {0, 0, 30 + draw});
    r.outcome = q.judge(r.path).accepted ? Outcome::solved : Outcome::exhausted;
    return r;
  };
  const Assembly assembly = fake::tube_with_blocks(2);
  std::set<std::string> plans;
  for (const std::uint64_t seed : {1, 2, 1}) {
    RunContext context;
    context.rng = Rng(99 + plans.size());  // does not matter
    RunOptions options;
    options.seed = seed;
    const RunResult r = run(assembly, fake::ingredients(marks, std::make_shared<InTurn>()), options, context);
    EXPECT_EQ(r.plan.seed, seed);
    plans.insert(text_without_times(r.plan));
  }
  EXPECT_EQ(plans.size(), 2u);
}

TEST(Run, EachStepIsHandedOnAsItIsDone) {
  std::vector<std::size_t> seen;
  RunContext context;
  const auto keep = [&](const Plan& plan) {
    seen.push_back(plan.disassembly.size());
    EXPECT_EQ(plan.assembly_steps.size(), plan.disassembly.size());
    EXPECT_EQ(plan.status == PlanStatus::complete, plan.disassembly.size() == 3);
    if (seen.size() == 2) throw std::runtime_error("disk full");  // must not stop the run
  };
  std::vector<std::string> errors;
  context.on_log = [&](LogLevel level, std::string_view text) {
    if (level == LogLevel::error) errors.emplace_back(text);
  };
  const RunResult r = run(fake::tube_with_blocks(3), fake::ingredients(fake::push, std::make_shared<InTurn>()),
                          RunOptions{}, context, keep);
  EXPECT_EQ(r.outcome, Outcome::solved);
  EXPECT_EQ(seen, (std::vector<std::size_t>{1, 2, 3}));
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("disk full"), std::string::npos);
}

TEST(Run, CancellationKeepsTheStepsDone) {
  for (const unsigned threads : {1u, 3u}) {
    RunContext context;
    context.threads = threads;
    const auto stop_after_two = [&](const Plan& plan) {
      if (plan.disassembly.size() == 2) context.cancel.cancel();
    };
    const RunResult r = run(fake::tube_with_blocks(4), fake::ingredients(fake::push, std::make_shared<InTurn>()),
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
  const RunResult r = run(fake::closed_box(), fake::ingredients(fake::push), options, context);
  EXPECT_EQ(r.outcome, Outcome::exhausted);
  EXPECT_EQ(r.plan.status, PlanStatus::partial);
  EXPECT_TRUE(r.plan.disassembly.empty());
  ASSERT_EQ(r.plan.unsolved.size(), 1u);
  EXPECT_EQ(r.plan.unsolved[0].blocked_by, (std::vector<std::string>{"box"}));
}

TEST(Run, OnePartOnly) {
  RunOptions options;
  options.only_part = "block2";
  Ingredients parts = fake::ingredients(fake::push);  // no sequence planner needed
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
  const RunResult r =
      run(fake::tube_with_blocks(2), fake::ingredients(fake::push, std::make_shared<Custom>(one_then_throw)),
          RunOptions{}, context);
  EXPECT_EQ(r.outcome, Outcome::crashed);
  EXPECT_EQ(r.plan.disassembly.size(), 1u);
  EXPECT_EQ(r.plan.unsolved.size(), 2u);
}

TEST(Run, NoStepIsBookedThatTheOracleDidNotAllow) {
  const AttemptResult forged{fake::outcome(Outcome::solved), 0, 0};
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
         without.still.pop_back();
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
    const RunResult r = run(fake::tube_with_blocks(2), fake::ingredients(fake::push, std::make_shared<Custom>(steps)),
                            RunOptions{}, context);
    EXPECT_EQ(r.outcome, Outcome::crashed) << name;
    EXPECT_TRUE(r.plan.disassembly.empty()) << name;
    EXPECT_EQ(r.plan.unsolved.size(), 3u) << name;
  }
}

TEST(Run, AGroupComesOutWholeAndIsTakenApartLater) {
  const auto lift = [](const PathQuery& q, RunContext&) {
    PathResult r;
    r.path = fake::straight(q.cast, {0, 0, 30});
    r.outcome = q.judge(r.path).accepted ? Outcome::solved : Outcome::exhausted;
    return r;
  };
  const auto in_groups = [](const Assembly&, PathOracle& oracle, SequenceObserver& observer, RunContext& c) {
    Attempt both;
    both.moving = {{2, Pose{}}, {1, Pose{}}};
    both.still = {{0, Pose{}}};
    SequenceResult result;
    const AttemptResult& up = oracle.attempt(both, c);
    result.removals.push_back({{2, 1}, &up});
    observer.removed(result.removals.back(), 1);
    Attempt apart;
    apart.moving = {{2, up.result.path.back()[0]}};
    apart.still = {{1, up.result.path.back()[1]}};
    result.removals.push_back({{2}, &oracle.attempt(apart, c)});
    observer.removed(result.removals.back(), 1);
    result.outcome = Outcome::solved;
    result.remaining = {0};
    return result;
  };
  RunContext context;
  const RunResult r = run(fake::tube_with_blocks(2), fake::ingredients(lift, std::make_shared<Custom>(in_groups)),
                          RunOptions{}, context);
  EXPECT_EQ(r.outcome, Outcome::solved);
  ASSERT_EQ(r.plan.disassembly.size(), 2u);
  EXPECT_EQ(r.plan.disassembly[0].separates, (std::vector<std::vector<std::string>>{{"block2", "block1"}}));
  EXPECT_EQ(r.plan.remaining, (std::vector<std::string>{"tube"}));
  const auto& first = r.plan.disassembly[0].moves[0].poses;
  const auto& second = r.plan.disassembly[1].moves[0].poses;
  EXPECT_EQ(first.back().t, second.front().t);  // rule (a)
}

/// Lifts blocks by bits, in the order given; the last bit of a block brings it out.
RunResult in_bits(const std::vector<PartId>& order) {
  const auto bits = [&](const Assembly& assembly, PathOracle& oracle, SequenceObserver& observer, RunContext& c) {
    SequenceResult result;
    std::vector<Pose> at(assembly.parts.size());
    std::vector<bool> gone(assembly.parts.size(), false);
    for (std::size_t k = 0; k < order.size(); ++k) {
      const PartId part = order[k];
      const bool last = std::count(order.begin() + static_cast<std::ptrdiff_t>(k), order.end(), part) == 1;
      Attempt a;
      a.part_way = !last;
      a.moving = {{part, at[part]}};
      for (const auto& p : assembly.parts)
        if (p.id != part && !gone[p.id]) a.still.push_back({p.id, at[p.id]});
      const Path way = fake::straight({a.moving, a.still}, {0, 0, last ? 30 : 0.25});
      const AttemptResult& r = oracle.propose(a, way, c);
      at[part] = r.result.path.back()[0];
      gone[part] = last;
      result.removals.push_back({{part}, &r, !last});
      observer.removed(result.removals.back(), 1);
    }
    result.outcome = Outcome::solved;
    return result;
  };
  RunContext context;
  return run(fake::tube_with_blocks(2), fake::ingredients(fake::push, std::make_shared<Custom>(bits)), RunOptions{},
             context);
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

TEST(Run, ASimulatorThatCannotPrepare) {
  Ingredients parts = fake::ingredients(fake::push, std::make_shared<InTurn>());
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
