// Searches in which each part moves along its own path: coupled points in mazes.
#include <algorithm>
#include <cmath>

#include "maze.h"

namespace dismantle::bfs {
namespace {

using namespace push::test;

constexpr double kTight = 1e-9;

/// Point 0 lies in a tunnel along x, point 1 in one along y.
Maze crossed() {
  return {.free = {tunnel(Vector3d(-30, 0, 0), Vector3d(30, 0, 0), 1e-4),
                   tunnel(Vector3d(0, -30, 0), Vector3d(0, 30, 0), 1e-4)}};
}

bool in_own_tunnel(const State& s) {
  const Vector3d &a = s.bodies[0].pose.t, &b = s.bodies[1].pose.t;
  return std::abs(a.y()) + std::abs(a.z()) + std::abs(b.x()) + std::abs(b.z()) < kTight;
}

bool is_pushed(const Action& action, std::size_t body) { return action.wrenches[body].force.norm() > 0; }

/// Coupled as by a rack: y of point 1 is `ratio` times x of point 0. A part that is not pushed is dragged along.
Maze geared(double ratio) {
  Maze maze = crossed();
  maze.link = [ratio](State& s, const Action& action) {
    double &x = s.bodies[0].pose.t.x(), &y = s.bodies[1].pose.t.y();
    if (!is_pushed(action, 1))
      y = ratio * x;
    else if (!is_pushed(action, 0))
      x = y / ratio;
    return in_own_tunnel(s) && std::abs(y - ratio * x) < kTight;
  };
  return maze;
}

/// Coupled as two doors that open each other: both points move by the same distance or not at all. None is dragged.
Maze hand_in_hand() {
  Maze maze = crossed();
  maze.link = [](State& s, const Action&) {
    return in_own_tunnel(s) && std::abs(s.bodies[0].pose.t.x() - s.bodies[1].pose.t.y()) < kTight;
  };
  return maze;
}

void go(MazeRun& run, const Maze& maze, const std::vector<PartId>& leaving, const char* planner = "bfs",
        const Budget& effort = {.max_depth = 1}) {
  search(run, maze, {}, effort, accept, {}, 2, {true, true, true, 4}, planner, leaving);
}

TEST(EachItsWay, WhoeverIsDrivenTheOtherIsDraggedAlong) {
  for (const char* planner : {"bfs", "contact_search"})
    for (const double ratio : {0.5, 1.0, 2.0})
      for (const PartId out : {PartId{0}, PartId{1}}) {
        MazeRun run;
        const Maze maze = geared(ratio);
        go(run, maze, {out}, planner);
        ASSERT_EQ(run.result.outcome(), Outcome::solved) << planner << ratio;
        EXPECT_EQ(run.result.depth, 1u);
        const std::vector<Pose>& end = run.result.path()->poses().back();
        EXPECT_NEAR(end[1].t.y(), ratio * end[0].t.x(), 1e-6);
        EXPECT_FALSE(maze.exit.contains(end[out].t)) << "it is out";
        if (ratio == 1.0) continue;
        EXPECT_EQ(maze.exit.contains(end[1 - out].t), (ratio < 1) == (out == 0)) << "it ends as soon as that one is";
      }
}

TEST(EachItsWay, AnyOfThoseThatMayLeaveWillDo) {
  MazeRun run;
  const Maze maze = geared(2.0);
  go(run, maze, {0, 1});
  ASSERT_EQ(run.result.outcome(), Outcome::solved);
  EXPECT_FALSE(maze.exit.contains(run.result.path()->poses().back()[1].t)) << "the faster one";
  EXPECT_TRUE(maze.exit.contains(run.result.path()->poses().back()[0].t));
}

/// Each refusal says where the parts are and which contact was not seen: the next form goes through there, moved off.
TEST(EachItsWay, ARefusedPathIsRepairedWhereItWasRefused) {
  const std::vector<double> heights{0.011, -0.013, 0.017};  // beside the path, in the order of the refusals
  MazeRun run;
  const auto accept_repaired = [&](const Path& path) {
    Ruling ruling;
    const auto goes_through = [&](double z) {
      return std::any_of(path.begin(), path.end(), [&](const auto& row) { return row[0].t.z() == z; });
    };
    const auto missing = std::find_if_not(heights.begin(), heights.end(), goes_through);
    ruling.accept = missing == heights.end();
    if (ruling.accept) return ruling;
    ruling.has_witness = true;
    ruling.part = 0;
    ruling.other = 2;
    ruling.poses.assign(2, Pose{});
    ruling.poses[0].t.z() = *missing;
    return ruling;
  };
  search(run, geared(1.0), {}, {.max_depth = 1}, accept_repaired, {}, 2, {true, true, true, 4}, "contact_search",
         {0, 1});
  ASSERT_EQ(run.result.outcome(), Outcome::solved);
  EXPECT_EQ(run.checked.size(), 1 + 1 + heights.size())
      << "the path, the one with room, and one for each refusal of it";
  EXPECT_EQ(run.notes.learned, 1 + heights.size()) << "also the contact of the first refusal";
}

TEST(EachItsWay, ARunEndsWhereAllHaveLeftTogether) {
  for (const char* planner : {"bfs", "contact_search"}) {
    MazeRun run;
    Maze maze = geared(1.0);
    maze.hold_each_other = true;
    go(run, maze, {0, 1}, planner);
    EXPECT_EQ(run.result.outcome(), Outcome::depth_limit) << planner;
    ASSERT_EQ(run.result.best_pose.size(), 2u);
    EXPECT_GT(run.result.best_pose[0].t.norm(), 4.5) << planner;
    EXPECT_LT(run.result.best_pose[0].t.norm(), 6) << planner << ": the tunnel is 30 long";
  }
}

TEST(EachItsWay, TwoAreDrivenAtOnceWhereOneIsNotEnough) {
  for (const char* planner : {"bfs", "contact_search"}) {
    MazeRun run;
    go(run, hand_in_hand(), {0}, planner, {.max_depth = 2});
    ASSERT_EQ(run.result.outcome(), Outcome::solved) << planner;
    const auto& end = run.result.path()->poses().back();
    EXPECT_GT(std::abs(end[0].t.x()), 5);
    EXPECT_NEAR(end[0].t.x(), end[1].t.y(), 1e-6);
    ASSERT_EQ(run.checked.size(), 1u);
  }
  // As one group they cannot move.
  MazeRun group;
  search(group, hand_in_hand(), {}, {.max_depth = 2}, accept, {}, 2);
  EXPECT_NE(group.result.outcome(), Outcome::solved);
}

/// By translation and, times the square of the number of parts, with rotation.
TEST(EachItsWay, UnderADepthLimitTheStepsAreCounted) {
  // A closed room with space to move; no part is dragged.
  const Maze maze{.free = {Aabb{Vector3d::Constant(-3), Vector3d::Constant(3)}}};
  for (const unsigned depth : {1U, 4U}) {
    MazeRun run;
    go(run, maze, {0, 1}, "contact_search", {.max_depth = depth});
    EXPECT_EQ(run.result.outcome(), Outcome::depth_limit);
    EXPECT_EQ(run.result.stats.steps, run.notes.steps);
    EXPECT_LE(run.notes.steps, (1 + 4) * (2000 * depth + 10))
        << "in both motion spaces, and an advance is not cut short";
    MazeRun less;
    go(less, maze, {0, 1}, "contact_search", {.max_depth = depth, .max_steps = 300});
    EXPECT_EQ(less.result.outcome(), Outcome::timeout) << "the asker's budget is used up, not that of the depth";
    EXPECT_LE(less.notes.steps, 310u);
  }
}

TEST(EachItsWay, SaysHowFarTheSecondHasCome) {
  // Only point 0 can move, by 3.
  Maze maze{.free = {Aabb{Vector3d::Constant(-3), Vector3d::Constant(3)}}};
  maze.link = [](State& s, const Action&) { return s.bodies[1].pose.t.norm() < kTight; };
  MazeRun alone, both;
  go(alone, maze, {0, 1});
  EXPECT_EQ(alone.result.outcome(), Outcome::depth_limit);
  EXPECT_EQ(alone.result.best_pose[1].t, Vector3d::Zero());
  Maze rack = geared(1.0);
  rack.free = {tunnel(Vector3d(-3, 0, 0), Vector3d(3, 0, 0), 1e-4),
               tunnel(Vector3d(0, -3, 0), Vector3d(0, 3, 0), 1e-4)};
  go(both, rack, {0, 1});
  EXPECT_GT(both.result.best_pose[0].t.norm(), 2.5);
  EXPECT_GT(both.result.best_pose[1].t.norm(), 2.5);
}

}  // namespace
}  // namespace dismantle::bfs
