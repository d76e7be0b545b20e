// Algorithm 1 in mazes with known solutions: outcomes, costs and reports of searches.
#include "maze.h"

namespace dismantle::bfs {
namespace {

using namespace push::test;

const ParamSet kTranslation{{"motion", std::string("translation")}};
/// One action along one axis at a time, as in section 4.2.
const ParamSet kAxesOnly{{"motion", std::string("translation")}, {"diagonals", false}};

Maze straight() { return {.free = {tunnel(Vector3d::Zero(), Vector3d(7, 0, 0))}}; }

/// A tunnel with `bends` corners; leaving it takes `bends` + 1 actions.
Maze winding(int bends) {
  Maze maze;
  Vector3d at = Vector3d::Zero();
  for (int k = 0; k <= bends; ++k) {
    const Vector3d to = at + (k == bends ? 9.0 : 1.5) * Vector3d::Unit(k % 3);
    maze.free.push_back(tunnel(at, to));
    at = to;
  }
  return maze;
}

void expect_lawful(const MazeRun& run, const Maze& maze) {
  EXPECT_EQ(run.result.stats.steps, run.notes.steps);
  for (const PartId p : run.result.blocked_by) EXPECT_EQ(p, 9u);
  ASSERT_EQ(run.result.best_pose.size(), 1u);
  if (run.result.outcome() != Outcome::solved) {
    EXPECT_FALSE(run.result.path());
    return;
  }
  ASSERT_GE(run.result.path()->poses().size(), 2u);
  EXPECT_EQ(run.result.path()->poses().front()[0].t, Vector3d::Zero());
  EXPECT_FALSE(maze.exit.contains(run.result.path()->poses().back()[0].t));
  ASSERT_FALSE(run.checked.empty());
  ASSERT_EQ(run.checked.back().size(), run.result.path()->poses().size());
  for (std::size_t k = 0; k < run.result.path()->poses().size(); ++k)
    EXPECT_EQ(run.checked.back()[k][0].t, run.result.path()->poses()[k][0].t) << "what is returned is what was checked";
}

TEST(BfsMaze, FindsTheWayWithTheFewestActions) {
  for (int bends = 0; bends <= 5; ++bends) {
    MazeRun run;
    const Maze maze = winding(bends);
    search(run, maze, kTranslation);
    EXPECT_EQ(run.result.outcome(), Outcome::solved) << bends;
    EXPECT_EQ(run.result.depth, static_cast<unsigned>(bends + 1));
    EXPECT_TRUE(run.result.message.empty());
    expect_lawful(run, maze);
  }
}

TEST(BfsMaze, DepthLimitIsTheNumberOfActions) {
  for (const char* motion : {"translation", "auto"})
    for (unsigned limit = 1; limit <= 4; ++limit) {
      MazeRun run;
      const Maze maze = winding(2);
      ParamSet axes = kAxesOnly;
      axes["motion"] = std::string(motion);
      search(run, maze, axes, {.max_depth = limit});
      EXPECT_EQ(run.result.outcome(), limit < 3 ? Outcome::depth_limit : Outcome::solved) << motion << limit;
      EXPECT_LE(run.result.depth, limit);
      expect_lawful(run, maze);
    }
}

TEST(BfsMaze, OpenSpaceIsOneAction) {
  MazeRun run;
  const Maze maze{.free = {Aabb{Vector3d::Constant(-50), Vector3d::Constant(50)}}};
  search(run, maze);
  EXPECT_EQ(run.result.outcome(), Outcome::solved);
  EXPECT_EQ(run.result.depth, 1u);
  EXPECT_EQ(run.result.path()->poses().size(), 2u) << "a straight way is two instants";
  expect_lawful(run, maze);
}

TEST(BfsMaze, AClosedRoomIsExhausted) {
  for (const char* motion : {"translation", "rotation", "auto"})
    for (const double size : {0.0, 0.05, 0.4}) {
      MazeRun run;
      const Maze maze{.free = {Aabb{Vector3d::Constant(-size), Vector3d::Constant(size)}}};
      search(run, maze, {{"motion", std::string(motion)}, {"diagonals", size < 0.1}}, {.max_steps = 1'000'000});
      EXPECT_EQ(run.result.outcome(), Outcome::exhausted) << motion << size;
      EXPECT_TRUE(run.checked.empty());
      EXPECT_EQ(run.result.blocked_by, std::vector<PartId>{9});
      expect_lawful(run, maze);
      EXPECT_EQ(run.notes.worlds, std::string(motion) == "auto" ? 2u : 1u);
    }
}

TEST(BfsMaze, DiagonalsAreTriedLastAndCanBeSwitchedOff) {
  // A staircase so fine that no motion along one axis makes progress.
  Maze maze;
  for (int k = 0; k < 700; ++k)
    maze.free.push_back(tunnel(0.01 * k * Vector3d(1, 1, 0), 0.01 * k * Vector3d(1, 1, 0), 0.007));
  MazeRun with, without;
  search(with, maze, kTranslation);
  EXPECT_EQ(with.result.outcome(), Outcome::solved);
  expect_lawful(with, maze);
  ParamSet off = kTranslation;
  off["diagonals"] = false;
  search(without, maze, off);
  EXPECT_EQ(without.result.outcome(), Outcome::exhausted);
  EXPECT_LT(without.result.stats.steps, with.result.stats.steps);
}

TEST(BfsMaze, StatesInTheMiddleOfARunAreSearchedToo) {
  // The side tunnel opens half-way along a longer one: no run ends there.
  Maze maze{
      .free = {tunnel(Vector3d::Zero(), Vector3d(3, 0, 0)), tunnel(Vector3d(1.5, 0, 0), Vector3d(1.5, 9, 0), 0.2)}};
  MazeRun run;
  search(run, maze, kAxesOnly);
  EXPECT_EQ(run.result.outcome(), Outcome::solved);
  EXPECT_EQ(run.result.depth, 2u);
  expect_lawful(run, maze);
}

TEST(BfsMaze, StartIsGoal) {
  MazeRun run;
  Maze maze = straight();
  maze.exit = {Vector3d::Constant(1), Vector3d::Constant(2)};
  search(run, maze);
  EXPECT_EQ(run.result.outcome(), Outcome::start_is_goal);
  EXPECT_EQ(run.notes.advances, 0u);
  EXPECT_FALSE(run.result.path()) << "there is nothing to verify";
}

TEST(BfsMaze, CancelledBeforeAndDuring) {
  for (const std::uint64_t at : {0u, 1u, 7u}) {
    RunContext context;
    const CancelToken cancel = context.cancel;
    MazeRun run;
    if (at == 0) cancel.cancel();
    run.notes.on_advance = [&] {
      if (run.notes.advances == at) cancel.cancel();
    };
    const Maze maze = winding(4);
    search(run, maze, {}, {}, accept, context);
    EXPECT_EQ(run.result.outcome(), Outcome::cancelled);
    EXPECT_EQ(run.notes.advances, at) << "no further look once told to stop";
    expect_lawful(run, maze);
  }
}

TEST(BfsMaze, AfterTheDeadlineItIsATimeout) {
  RunContext context;
  context.deadline = Deadline::after_seconds(0);
  MazeRun run;
  search(run, straight(), {}, {}, accept, context);
  EXPECT_EQ(run.result.outcome(), Outcome::timeout);
  EXPECT_EQ(run.notes.advances, 0u);
}

TEST(BfsMaze, StepBudgetsAreKept) {
  MazeRun all;
  const Maze maze = winding(3);
  search(all, maze);
  ASSERT_EQ(all.result.outcome(), Outcome::solved);
  for (const std::uint64_t budget : {1u, 10u, 57u, 200u}) {
    MazeRun run;
    search(run, maze, {}, {.max_steps = budget});
    if (all.notes.steps > budget + maze.steps_per_advance) {
      EXPECT_EQ(run.result.outcome(), Outcome::timeout) << budget;
    }
    EXPECT_LT(run.notes.steps, budget + maze.steps_per_advance) << "at most one look too far";
    expect_lawful(run, maze);
  }
  MazeRun enough;
  search(enough, maze, {}, {.max_steps = all.notes.steps + 1});
  EXPECT_EQ(enough.result.outcome(), Outcome::solved);
}

TEST(BfsMaze, BothSearchesOfAutoShareOneStepBudget) {
  const Maze maze{.free = {Aabb{Vector3d::Constant(-0.05), Vector3d::Constant(0.05)}}};
  MazeRun translation, both;
  search(translation, maze, kTranslation);
  ASSERT_EQ(translation.result.outcome(), Outcome::exhausted);
  search(both, maze, {}, {.max_steps = translation.notes.steps + 5});
  EXPECT_EQ(both.result.outcome(), Outcome::timeout);
  EXPECT_LT(both.notes.steps, translation.notes.steps + 5 + maze.steps_per_advance);
}

/// Two exits: +x, which is tried first, and -z.
Maze two_ways() {
  return {.free = {tunnel(Vector3d::Zero(), Vector3d(7, 0, 0)), tunnel(Vector3d::Zero(), Vector3d(0, 0, -7))},
          .free_after_learning = {tunnel(Vector3d::Zero(), Vector3d(1, 0, 0)),
                                  tunnel(Vector3d::Zero(), Vector3d(0, 0, -7))}};
}

Ruling refuse_x(const Path& path, bool witness) {
  Ruling v;
  v.accept = path.back()[0].t.x() < 1;
  v.has_witness = witness && !v.accept;
  v.reason = v.accept ? "" : "through the wall";
  return v;
}

TEST(BfsMaze, LearnsFromARefusal) {
  MazeRun run;
  const Maze maze = two_ways();
  search(run, maze, {}, {}, [](const Path& p) { return refuse_x(p, true); });
  EXPECT_EQ(run.result.outcome(), Outcome::solved);
  EXPECT_EQ(run.notes.learned, 1u);
  EXPECT_EQ(run.checked.size(), 2u) << "the world holds now what the verifier refused";
  EXPECT_EQ(run.result.stats.refused, 1u);
  EXPECT_LT(run.result.path()->poses().back()[0].t.z(), -4.9);
  EXPECT_TRUE(run.result.message.empty());
  expect_lawful(run, maze);
}

TEST(BfsMaze, GoesOnAfterARefusalWithoutWitness) {
  MazeRun run;
  const Maze maze = two_ways();
  search(run, maze, {}, {}, [](const Path& p) { return refuse_x(p, false); });
  EXPECT_EQ(run.result.outcome(), Outcome::solved);
  EXPECT_EQ(run.notes.learned, 0u);
  EXPECT_LT(run.result.path()->poses().back()[0].t.z(), -4.9);
  expect_lawful(run, maze);
}

TEST(BfsMaze, WhatIsAlwaysRefusedIsNeverSolved) {
  for (const bool witness : {false, true})
    for (const std::int64_t most : {0, 1, 8}) {
      MazeRun run;
      const Maze maze{.free = {Aabb{Vector3d::Constant(-50), Vector3d::Constant(50)}}};
      search(run, maze, {{"max_refusals", most}}, {}, [&](const Path&) {
        Ruling v;
        v.has_witness = witness;
        v.reason = "no";
        return v;
      });
      EXPECT_FALSE(is_success(run.result.outcome()));
      EXPECT_FALSE(run.result.path());
      EXPECT_EQ(run.result.message, "no") << "the verifier's reason is handed on";
      expect_lawful(run, maze);
    }
}

TEST(BfsMaze, RefusalsAreLimited) {
  MazeRun run;
  const Maze maze{.free = {Aabb{Vector3d::Constant(-50), Vector3d::Constant(50)}}};
  ParamSet given = kTranslation;
  given["max_refusals"] = std::int64_t{3};
  search(run, maze, given, {}, [](const Path&) { return Ruling{}; });
  EXPECT_EQ(run.checked.size(), 4u);
}

TEST(BfsMaze, SameCallsSamePathWhateverTheSeed) {
  const Maze maze = winding(4);
  MazeRun first;
  search(first, maze);
  for (const std::uint64_t seed : {1u, 2u, 99u}) {
    RunContext context;
    context.rng = Rng(seed);
    MazeRun run;
    search(run, maze, {}, {}, accept, context);
    ASSERT_EQ(run.result.path()->poses().size(), first.result.path()->poses().size());
    for (std::size_t k = 0; k < run.result.path()->poses().size(); ++k)
      EXPECT_EQ(run.result.path()->poses()[k][0].t, first.result.path()->poses()[k][0].t);
    EXPECT_EQ(run.result.stats, first.result.stats);
  }
}

TEST(BfsMaze, NeedsDynamicsAndContactsForAllThatMove) {
  for (const Capabilities has : {Capabilities{false, true, true, 4}, {true, false, true, 4}, {true, true, true, 1}}) {
    MazeRun run;
    search(run, straight(), {}, {}, accept, {}, 2, has);
    EXPECT_EQ(run.result.outcome(), Outcome::unsupported);
    EXPECT_FALSE(run.result.message.empty());
    EXPECT_EQ(run.notes.advances, 0u);
  }
}

TEST(BfsMaze, SeveralPartsMoveAsOne) {
  MazeRun run;
  search(run, winding(2), {}, {}, accept, {}, 3);
  ASSERT_EQ(run.result.outcome(), Outcome::solved);
  for (const auto& instant : run.result.path()->poses()) {
    ASSERT_EQ(instant.size(), 3u);
    EXPECT_EQ(instant[0].t, instant[2].t);
  }
}

TEST(BfsMaze, TheBestPoseIsTheFurthest) {
  MazeRun run;
  const Maze maze{.free = {tunnel(Vector3d(-1, 0, 0), Vector3d(3, 0, 0))}};
  search(run, maze, {{"motion", std::string("translation")}, {"diagonals", false}}, {.max_steps = 1'000'000});
  EXPECT_EQ(run.result.outcome(), Outcome::exhausted);
  ASSERT_EQ(run.result.best_pose.size(), 1u);
  EXPECT_NEAR(run.result.best_pose[0].t.x(), 3, 0.1);
}

}  // namespace
}  // namespace dismantle::bfs
