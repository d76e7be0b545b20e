// Simultaneous motions: which sets of parts are asked for, and what the planner does with the answers.
#include <gtest/gtest.h>

#include <set>

#include "blocking/blocking.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/testing/barred_shaft.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {
namespace {

/// Finds only the simultaneous motion of barred_shaft(): the bar aside and the drawer up. Records the questions.
struct AtOnce {
  std::vector<std::vector<PartId>>* leaving = nullptr;
  PathResult operator()(const PathQuery& q, RunContext&) const {
    if (q.goal.any_of.empty()) return fake::outcome(Outcome::depth_limit);
    leaving->push_back(q.goal.any_of);
    const PathResult none = fake::outcome(Outcome::depth_limit);
    if (q.scene.moving.size() != 2 || q.scene.moving[0].part != 1) return none;
    Path path(3, {Pose{}, Pose{}});
    path[1][0].t.x() = path[2][0].t.x() = 2;
    path[2][1].t.z() = 8;
    const PathResult shown = fake::shown(q, path);
    return shown.path() ? shown : none;
  }
};

TEST(Blocking, MovesTwoAtOnceWhereOneIsHeldByTheOtherAlone) {
  BlockingParameters params;
  params.groups = params.rotations = false;
  params.translation_states = 0;
  for (const bool at_once : {true, false}) {
    params.simultaneous = at_once;
    std::set<std::string> plans;
    for (const unsigned threads : {1U, 3U}) {
      std::vector<std::vector<PartId>> leaving;
      RunContext context;
      context.threads = threads;
      RunResult r =
          run(barred_shaft(), fake::setup(AtOnce{&leaving}, std::make_shared<Blocking>(params)), RunOptions{}, context);
      ASSERT_EQ(r.plan.disassembly.size(), at_once ? 1u : 0u);
      if (!at_once) {
        EXPECT_TRUE(leaving.empty());
        continue;
      }
      EXPECT_EQ(leaving, (std::vector<std::vector<PartId>>{{1, 2}})) << "the housing stay fixed";
      const PlanStep& step = r.plan.disassembly[0];
      EXPECT_EQ(step.moves.size(), 2u);
      EXPECT_EQ(step.separates, (std::vector<std::vector<std::string>>{{"drawer"}}));
      EXPECT_EQ(r.plan.unsolved.size(), 2u) << "the bar never leaves";
      EXPECT_TRUE(check_plan(r.plan, barred_shaft(), RunOptions{}.verify, context).valid);
      for (auto* steps : {&r.plan.disassembly, &r.plan.assembly_steps})
        for (PlanStep& s : *steps) s.seconds = 0;
      for (PlanUnsolved& u : r.plan.unsolved) u.seconds = 0;
      plans.insert(to_json(r.plan));
    }
    EXPECT_LE(plans.size(), 1u);
  }
}

TEST(Blocking, WhoMayNotLeaveOrMoveIsNotAskedForAtOnce) {
  BlockingParameters params;
  params.groups = params.rotations = false;
  params.translation_states = 0;
  const auto asked = [&](const Constraints& constraints) {
    std::vector<std::vector<PartId>> leaving;
    RunOptions options;
    options.constraints = constraints;
    RunContext context;
    run(barred_shaft(), fake::setup(AtOnce{&leaving}, std::make_shared<Blocking>(params)), options, context);
    return leaving;
  };
  Constraints before, base, together;
  before.before = {{2, 1}};
  EXPECT_EQ(asked(before), (std::vector<std::vector<PartId>>{{2}})) << "the bar leaves after the drawer";
  base.base = {1};
  EXPECT_TRUE(asked(base).empty());
  together.together = {{0, 1}};
  EXPECT_TRUE(asked(together).empty()) << "two are left, and move as one each";
}

TEST(Blocking, SetsThatMoveAtOnceAreFewHoweverManyPartsAreLeft) {
  Assembly many = barred_shaft();
  constexpr unsigned kShafts = 16;
  std::vector<Mesh> frames(1, *many.parts[0].mesh);
  for (unsigned k = 1; k < kShafts; ++k)
    for (PartId id = 0; id < 3; ++id) {
      Mesh mesh = *many.parts[id].mesh;
      for (auto& v : mesh.vertices) v.y() += 4.5 * k;
      if (id == 0) {
        frames.push_back(std::move(mesh));
        continue;
      }
      Part part = many.parts[id];
      part.id = static_cast<PartId>(many.parts.size());
      part.name += std::to_string(k);
      part.mesh = part.surface = std::make_shared<const Mesh>(std::move(mesh));
      many.parts.push_back(std::move(part));
    }
  Mesh frame;
  for (const Mesh& mesh : frames) {
    const auto base = static_cast<std::uint32_t>(frame.vertices.size());
    frame.vertices.insert(frame.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const Triangle& t : mesh.triangles) frame.triangles.push_back({base + t[0], base + t[1], base + t[2]});
  }
  many.parts[0].mesh = many.parts[0].surface = std::make_shared<const Mesh>(std::move(frame));
  std::size_t asked = 0;
  bool separable = true;  // two with all others taken away
  const auto in_vain = [&](const PathQuery& q, RunContext&) {
    PathResult r = fake::outcome(Outcome::depth_limit);
    if (q.goal.any_of.empty()) {
      if (separable && q.scene.moving.size() == 1 && q.scene.fixed.size() == 1)
        for (int d = 0; d < 6; ++d) {
          const Pose out{(d < 3 ? 30.0 : -30.0) * Eigen::Vector3d::Unit(d % 3), Eigen::Quaterniond::Identity()};
          if (PathResult straight = fake::shown(q, {{Pose{}}, {out}}); straight.path()) return straight;
        }
      return r;
    }
    ++asked;  // on one thread
    EXPECT_LE(q.scene.moving.size(), 3u);
    for (const PlacedPart& p : q.scene.moving) {
      EXPECT_NE(p.part, PartId{0});
      r.best_pose.push_back({p.pose.t + Eigen::Vector3d(0.5, 0, 0), p.pose.q});
    }
    return r;
  };
  BlockingParameters params;
  params.groups = params.rotations = false;
  params.translation_states = 0;
  const auto sets_asked = [&] {
    asked = 0;
    RunContext context;
    const RunResult r = run(many, fake::setup(in_vain, std::make_shared<Blocking>(params)), RunOptions{}, context);
    EXPECT_TRUE(r.plan.disassembly.empty());
    return asked;
  };
  EXPECT_EQ(sets_asked(), 14u) << "twelve of sixteen a little, two of them more";
  separable = false;
  EXPECT_EQ(sets_asked(), 12u) << "none more: two that hold each other do not separate by moving simultaneously";
}

}  // namespace
}  // namespace dismantle
