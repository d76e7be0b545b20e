#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/testing/oracle_rig.h"

namespace dismantle {
namespace {

using fake::leave;
using fake::outcome;
using fake::Rig;

double largest_way(const Mesh& mesh, const Pose& a, const Pose& b) {
  double most = 0;
  for (const auto& v : mesh.vertices) most = std::max(most, (a * v - b * v).norm());
  return most;
}

TEST(Oracle, PathIsDenseExactAtTheStartAndEndsWhereThePlannerSaid) {
  Rig s(fake::tube_with_blocks(2), fake::setup(fake::push));
  const AttemptResult& r = s.ask(leave(s.assembly, 2));
  ASSERT_EQ(r.result.outcome(), Outcome::solved);
  const Path& path = r.result.path()->poses();
  ASSERT_GE(path.size(), 2u);
  EXPECT_TRUE(path.front()[0].is_identity());
  EXPECT_NEAR((path.back()[0].t - Eigen::Vector3d(0, 0, 30)).norm(), 0, 1e-9);
  const double limit = 0.01 * s.assembly.input_box.size().maxCoeff();
  for (std::size_t k = 1; k < path.size(); ++k)
    EXPECT_LE(largest_way(*s.assembly.parts[2].mesh, path[k - 1][0], path[k][0]), limit);
  EXPECT_TRUE(s.verifier.check_motion({2}, leave(s.assembly, 2).fixed, path).valid);
}

TEST(Oracle, LeavesOutInstantsThatSayNothingNew) {
  const auto crawl = [](const PathQuery& q, RunContext&) {  // straight up in 50 000 steps
    Path path;
    for (int k = 0; k <= 50000; ++k) path.push_back(fake::straight(q.scene, {0, 0, k * 2e-4})[1]);
    return fake::shown(q, path);
  };
  Rig s(fake::tube_with_blocks(1), fake::setup(crawl));
  const AttemptResult& r = s.ask(leave(s.assembly, 1));
  ASSERT_EQ(r.result.outcome(), Outcome::solved);
  EXPECT_LT(r.result.path()->poses().size(), 300u);  // 10 units at 0.04 a piece
  EXPECT_NEAR(r.result.path()->poses().back()[0].t.z(), 10, 1e-9);
}

TEST(Oracle, APlannerCannotTalkAPathThroughAWall) {
  for (const bool asks_first : {false, true}) {
    const auto liar = [asks_first](const PathQuery& q, RunContext&) {
      const Path path = fake::straight(q.scene, {30, 0, 0});
      if (asks_first) {
        EXPECT_FALSE(q.checker.check(path).accepted());
      }
      return fake::forged(path);
    };
    Rig s(fake::tube_with_blocks(1), fake::setup(liar));
    const AttemptResult& r = s.ask(leave(s.assembly, 1));
    EXPECT_EQ(r.result.outcome(), Outcome::crashed);
    EXPECT_FALSE(r.result.path());
    EXPECT_NE(r.result.message.find("'scripted'"), std::string::npos) << r.result.message;
    ASSERT_EQ(s.errors.size(), 1u);
    EXPECT_EQ(s.errors[0], r.result.message);
  }
}

/// A path accepted for one attempt does not answer another.
TEST(Oracle, APathThatWasVerifiedForAnotherAttemptIsRefused) {
  std::optional<VerifiedPath> kept;
  const auto keeps = [&kept](const PathQuery& q, RunContext&) {
    PathResult r = kept ? PathResult{} : fake::shown(q, fake::straight(q.scene, {0, 0, 30}));
    if (kept)
      r.solve(*kept, 1);
    else
      kept = r.path();
    return r;
  };
  Rig s(fake::tube_with_blocks(1), fake::setup(keeps));
  Attempt question = leave(s.assembly, 1);
  EXPECT_EQ(s.ask(question).result.outcome(), Outcome::solved);
  question.moving[0].pose.t.z() = 0.01;
  EXPECT_EQ(s.ask(question).result.outcome(), Outcome::crashed);
}

TEST(Oracle, TheJudgeSaysWhere) {
  PathCheck said;
  const auto once = [&said](const PathQuery& q, RunContext&) {
    Path path = fake::straight(q.scene, {0, 0, -0.05});
    path.push_back(fake::straight(q.scene, {0, 0, -30})[1]);
    said = q.checker.check(path);
    return outcome(Outcome::exhausted);
  };
  Rig s(fake::tube_with_blocks(1), fake::setup(once));
  s.ask(leave(s.assembly, 1));
  EXPECT_FALSE(said.accepted());
  ASSERT_TRUE(said.has_witness);
  EXPECT_EQ(said.part + said.other, 1u);
  EXPECT_EQ(said.instant, 1u);
  EXPECT_FALSE(said.reason.empty());
  // Exactly there, not at the next instant.
  ASSERT_EQ(said.poses.size(), 1u);
  const PartId moving = 1;
  const Eigen::Vector3d seen = said.part == moving ? said.poses[0] * said.point : said.poses[0].inverse() * said.point;
  const Mesh& other = *s.assembly.parts[said.other].mesh;
  EXPECT_LT(TriangleBvh(other).signed_distance(seen), -0.009);
}

TEST(Oracle, RefusesPathsThatAreNoPaths) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto with = [](std::function<void(Path&)> spoil) {
    return [spoil](const PathQuery& q, RunContext&) {
      Path path = fake::straight(q.scene, {0, 0, 30});
      spoil(path);
      EXPECT_FALSE(q.checker.check(path).accepted());
      return fake::forged(path);
    };
  };
  const std::vector<std::function<void(Path&)>> spoilt{
      [](Path& p) { p.clear(); },
      [](Path& p) { p[1].clear(); },
      [&](Path& p) { p[1][0].t.x() = nan; },
      [](Path& p) { p[1][0].q.coeffs() *= 2; },
      [](Path& p) { p[0][0].t.z() = 0.01; },   // starts elsewhere
      [](Path& p) { p[1][0].t.z() = 0.2; },    // not out yet
      [](Path& p) { p[1][0].t.z() = 1e200; },  // runaway
      [](Path& p) { p.resize(1); },            // goes nowhere
  };
  for (std::size_t i = 0; i < spoilt.size(); ++i) {
    Rig s(fake::tube_with_blocks(1), fake::setup(with(spoilt[i])));
    EXPECT_EQ(s.ask(leave(s.assembly, 1)).result.outcome(), Outcome::crashed) << "case " << i;
  }
}

TEST(Oracle, StartIsGoalHasToBeTrue) {
  const auto lazy = [](const PathQuery&, RunContext&) { return outcome(Outcome::start_is_goal); };
  Rig apart(fake::row(2), fake::setup(lazy));
  const AttemptResult& yes = apart.ask(leave(apart.assembly, 0));
  EXPECT_EQ(yes.result.outcome(), Outcome::start_is_goal);
  EXPECT_EQ(yes.result.path()->poses().size(), 2u);
  Rig inside(fake::tube_with_blocks(1), fake::setup(lazy));
  EXPECT_EQ(inside.ask(leave(inside.assembly, 1)).result.outcome(), Outcome::crashed);
}

TEST(Oracle, WhatPluginsThrowBecomesAnOutcome) {
  const auto throws = [](const PathQuery& q, RunContext&) -> PathResult {
    if (q.scene.moving[0].part == 0) throw std::runtime_error("index out of range");
    throw 42;
  };
  Rig s(fake::row(2), fake::setup(throws));
  const AttemptResult& known = s.ask(leave(s.assembly, 0));
  EXPECT_EQ(known.result.outcome(), Outcome::crashed);
  EXPECT_NE(known.result.message.find("index out of range"), std::string::npos);
  EXPECT_EQ(s.ask(leave(s.assembly, 1)).result.outcome(), Outcome::crashed);
  EXPECT_EQ(s.errors.size(), 2u);

  PlanningSetup broken = fake::setup(fake::push);
  broken.path_planner = []() -> std::shared_ptr<PathPlanner> { throw std::runtime_error("no licence"); };
  Rig t(fake::row(2), broken);
  EXPECT_EQ(t.ask(leave(t.assembly, 0)).result.outcome(), Outcome::crashed);
  EXPECT_NE(t.ask(leave(t.assembly, 0)).result.message.find("no licence"), std::string::npos);
}

TEST(Oracle, ACrashIsNotHiddenByTheTimeLimit) {
  RunContext late;
  const auto throws = [&late](const PathQuery&, RunContext&) -> PathResult {
    late.deadline = Deadline::after_seconds(0);  // it passes during the attempt
    throw std::runtime_error("index out of range");
  };
  Rig s(fake::row(2), fake::setup(throws));
  late = s.context;
  late.deadline = Deadline::after_seconds(1e6);
  const AttemptResult& r = s.oracle->attempt(leave(s.assembly, 0), late);
  EXPECT_TRUE(late.deadline.passed());
  EXPECT_EQ(r.result.outcome(), Outcome::crashed);
  EXPECT_NE(r.result.message.find("index out of range"), std::string::npos);
}

/// A wrong path has the same outcome, whether or not the run was stopped meanwhile.
TEST(Oracle, AFalseClaimIsAFalseClaimHoweverLate) {
  for (const bool claims_start : {false, true}) {
    const auto claims = [=](const PathQuery& q, RunContext& context) {
      context.cancel.cancel();
      return claims_start ? outcome(Outcome::start_is_goal) : fake::forged(fake::straight(q.scene, {30, 0, 0}));
    };
    Rig s(fake::tube_with_blocks(1), fake::setup(claims));
    EXPECT_EQ(s.ask(leave(s.assembly, 1)).result.outcome(), Outcome::crashed);
  }
}

TEST(Oracle, StoppingUnaskedIsABug) {
  const auto quits = [](const PathQuery&, RunContext&) { return outcome(Outcome::cancelled); };
  Rig s(fake::row(2), fake::setup(quits));
  EXPECT_EQ(s.ask(leave(s.assembly, 0)).result.outcome(), Outcome::crashed);
}

TEST(Oracle, SaysWhatTheSimulatorLacks) {
  PlanningSetup parts = fake::setup(fake::push);
  auto simulator = std::make_shared<fake::Physics>();
  simulator->has = {.dynamics = false, .max_moving = 1};
  parts.simulator = simulator;
  Rig s(fake::row(3), parts);
  const AttemptResult& r = s.ask(leave(s.assembly, 0));
  EXPECT_EQ(r.result.outcome(), Outcome::unsupported);
  EXPECT_NE(r.result.message.find("dynamics"), std::string::npos);
  simulator->has.dynamics = true;
  Attempt two;
  two.moving = {{0, Pose{}}, {1, Pose{}}};
  two.fixed = {{2, Pose{}}};
  EXPECT_EQ(s.ask(two).result.outcome(), Outcome::unsupported);
}

TEST(Oracle, QuestionsWithoutSenseAreErrorsOfTheCaller) {
  Rig s(fake::row(3), fake::setup(fake::push));
  Attempt a = leave(s.assembly, 0);
  a.fixed.push_back({0, Pose{}});
  EXPECT_THROW(s.ask(a), std::invalid_argument);
  a = leave(s.assembly, 0);
  a.moving[0].part = 9;
  EXPECT_THROW(s.ask(a), std::invalid_argument);
  a.moving.clear();
  EXPECT_THROW(s.ask(a), std::invalid_argument);
  a = leave(s.assembly, 0);
  a.fixed[0].pose.t.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(s.ask(a), std::invalid_argument);
}

TEST(Oracle, NobodyLeftIsApartFromNobody) {
  Rig s(fake::row(1), fake::setup(fake::push));
  EXPECT_EQ(s.ask(leave(s.assembly, 0)).result.outcome(), Outcome::start_is_goal);
}

TEST(Oracle, NonsenseAboutBlockersIsDropped) {
  const auto babbles = [](const PathQuery&, RunContext&) {
    PathResult r = outcome(Outcome::exhausted);
    r.blocked_by = {7, 1, 0, 1, 2};
    r.best_pose = {Pose{}, Pose{}};
    return r;
  };
  Rig s(fake::row(3), fake::setup(babbles));
  const AttemptResult& r = s.ask(leave(s.assembly, 0));
  EXPECT_EQ(r.result.blocked_by, (std::vector<PartId>{1, 2}));
  EXPECT_TRUE(r.result.best_pose.empty());
}

/// Two blocks in a tube move up by different distances: the first by 0.1.
PathResult each_up(const PathQuery& q, double second) {
  Path path = fake::straight(q.scene, {0, 0, 0.1});
  path[1][1].t.z() = second;
  return fake::shown(q, path);
}

TEST(Oracle, OneOfThoseThatMoveAtOnceHasToBeOut) {
  std::size_t asked = 0;
  double second = 30;
  Rig s(fake::tube_with_blocks(2), fake::setup([&](const PathQuery& q, RunContext&) {
          ++asked;
          EXPECT_FALSE(q.goal.any_of.empty());
          return each_up(q, second);
        }));
  Attempt both;
  both.moving = {{1, Pose{}}, {2, Pose{}}};
  both.fixed = {{0, Pose{}}};
  both.goal.any_of = {2, 1};
  const AttemptResult& r = s.ask(both);
  EXPECT_EQ(r.result.outcome(), Outcome::solved) << r.result.message;
  EXPECT_EQ(r.out, PartId{2}) << "1 is in the tube still";
  both.goal.any_of = {2};
  EXPECT_EQ(s.ask(both).out, PartId{2});
  EXPECT_EQ(asked, 2u) << "another question: not answered from memory";
  both.goal.any_of = {2, 2};
  EXPECT_EQ(s.ask(both).out, PartId{2});
  both.goal.any_of = {1};
  EXPECT_EQ(s.ask(both).result.outcome(), Outcome::exhausted) << "2 is out, but it is 1 that was to leave";
  EXPECT_FALSE(s.ask(both).out);
  EXPECT_EQ(asked, 3u);
  second = 0.2;
  both.goal.any_of = {1, 2};
  both.max_depth = 2;
  EXPECT_EQ(s.ask(both).result.outcome(), Outcome::exhausted) << "nobody is out";
  EXPECT_EQ(asked, 4u);

  both.goal.any_of = {0};
  EXPECT_THROW(s.ask(both), std::invalid_argument) << "it does not move";
  both.goal.any_of = {1};
  both.goal.placement = true;
  EXPECT_THROW(s.ask(both), std::invalid_argument);
}

TEST(Oracle, PlannersThatMoveGroupsOnlyAreNotAskedForMore) {
  class Groups final : public FunctionPathPlanner {
   public:
    PathPlannerTraits traits() const noexcept override { return {}; }
    PathResult plan(const PathQuery&, RunContext&) override { throw std::logic_error("not to be asked"); }
  };
  fake::Script none;
  PlanningSetup setup = fake::setup(none);
  setup.path_planner = [] { return std::make_shared<Groups>(); };
  Rig s(fake::row(3), setup);
  Attempt both;
  both.moving = {{0, Pose{}}, {1, Pose{}}};
  both.fixed = {{2, Pose{}}};
  both.goal.any_of = {0};
  const AttemptResult& r = s.ask(both);
  EXPECT_EQ(r.result.outcome(), Outcome::unsupported);
  EXPECT_NE(r.result.message.find("independently at the same time"), std::string::npos);
}

TEST(Oracle, ChecksProposedPaths) {
  Rig s(fake::tube_with_blocks(2), fake::setup(fake::push));
  const auto up = [](const Attempt& a, double distance) {
    return fake::straight({a.moving, a.fixed}, Eigen::Vector3d(0, 0, distance));
  };
  const Attempt top = leave(s.assembly, 2), low = leave(s.assembly, 1);
  const AttemptResult& out = s.oracle->propose(top, up(top, 3), s.context);
  EXPECT_EQ(out.result.outcome(), Outcome::solved);
  EXPECT_EQ(out.result.path()->poses().back()[0].t, Eigen::Vector3d(0, 0, 3));
  const AttemptResult& blocked = s.oracle->propose(low, up(low, 3), s.context);
  EXPECT_EQ(blocked.result.outcome(), Outcome::exhausted);
  EXPECT_EQ(blocked.result.blocked_by, std::vector<PartId>{2});
  EXPECT_FALSE(blocked.result.message.empty());
  Attempt part_way = top;
  EXPECT_EQ(s.oracle->propose(top, up(top, 0.5), s.context).result.outcome(), Outcome::exhausted) << "not out";
  part_way.goal.placement = true;
  EXPECT_EQ(s.oracle->propose(part_way, up(top, 0.5), s.context).result.outcome(), Outcome::solved);
  Path elsewhere = up(top, 3);
  elsewhere[0][0].t.x() += 0.1;
  EXPECT_THROW(s.oracle->propose(top, elsewhere, s.context), std::invalid_argument);
  EXPECT_EQ(s.oracle->counts().proposed, 4u);
  EXPECT_EQ(s.oracle->counts().refused, 2u);
  EXPECT_EQ(s.oracle->counts().attempts, 0u);
}

}  // namespace
}  // namespace dismantle
