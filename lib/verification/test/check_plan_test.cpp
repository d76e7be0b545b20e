#include "dismantle/verification/check_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

using shapes::shift;
using shapes::Vec3;

/// Three blocks in a row along x, in input units of a hundredth of an assembly unit, off the origin.
class CheckPlan : public ::testing::Test {
 protected:
  CheckPlan() {
    assembly_ = shapes::assembly_of({shapes::box({-5, -1, -1}, {-2, 1, 1}), shapes::box({-2, -1, -1}, {2, 1, 1}),
                                     shapes::box({2, -1, -1}, {5, 1, 1})});
    assembly_.normalization = {0.01, {100, 200, 300}};
    plan_.status = PlanStatus::complete;
    for (const auto& p : assembly_.parts) plan_.assembly.parts.push_back({p.id, p.name, p.file});
    plan_.disassembly.push_back(slide(1, {"part0"}, {{-4, 0, 0}}, {{"part0"}}));
    plan_.disassembly.push_back(slide(2, {"part2"}, {{4, 0, 0}}, {{"part2"}}));
    plan_.remaining = {"part1"};
  }

  /// A straight path from pose `from`, with 0.09 assembly units between poses.
  std::vector<Pose> poses(const Vec3& path, const Pose& from = {}, int count = 0) const {
    std::vector<Pose> out;
    const int n = count > 0 ? count : std::max(1, static_cast<int>(std::ceil(path.norm() / 0.09)));
    for (int i = 0; i <= n; ++i) out.push_back(assembly_.normalization.pose_to_input({from.t + path * i / n, from.q}));
    return out;
  }
  PlanStep slide(unsigned number, const std::vector<std::string>& names, const std::vector<Vec3>& paths,
                 std::vector<std::vector<std::string>> separates) const {
    double longest = 0;
    for (const auto& w : paths) longest = std::max(longest, w.norm());
    PlanStep step;
    step.step = number;
    for (std::size_t i = 0; i < names.size(); ++i)
      step.moves.push_back({names[i], poses(paths[i], {}, std::max(1, static_cast<int>(std::ceil(longest / 0.09))))});
    step.separates = std::move(separates);
    return step;
  }
  PlanCheck check() const {
    RunContext context;
    return check_plan(plan_, assembly_, VerifyOptions{}, context);
  }
  void expect_problem(unsigned step, const std::string& text) const {
    const PlanCheck c = check();
    EXPECT_FALSE(c.valid);
    EXPECT_FALSE(c.complete);
    std::string all;
    for (const auto& p : c.problems) all += std::to_string(p.step) + ": " + p.message + "\n";
    EXPECT_TRUE(
        std::any_of(c.problems.begin(), c.problems.end(),
                    [&](const PlanProblem& p) { return p.step == step && p.message.find(text) != std::string::npos; }))
        << "expected in step " << step << ": " << text << "\nfound:\n"
        << all;
  }
  void reverse_into_assembly() {
    unsigned number = 0;
    for (auto it = plan_.disassembly.rbegin(); it != plan_.disassembly.rend(); ++it) {
      PlanStep back;
      back.step = ++number;
      back.moves = it->moves;
      for (auto& m : back.moves) std::reverse(m.poses.begin(), m.poses.end());
      plan_.assembly_steps.push_back(back);
    }
  }

  /// Displacement with which the disassembly left what assembly step `step` brings, and where that is when assembled.
  Vec3 bare_goal(std::size_t step) const {
    const auto& back = plan_.assembly_steps[step];
    return assembly_.normalization.pose_to_internal(back.moves[0].poses[back.transfer]).t;
  }
  Vec3 bare_place(std::size_t step) const {
    for (const auto& p : assembly_.parts)
      if (p.name == plan_.assembly_steps[step].moves[0].part) return p.mesh->box().center();
    return Vec3::Zero();
  }

  Assembly assembly_;
  Plan plan_;
};

TEST_F(CheckPlan, AGoodPlanIsValidAndComplete) {
  const PlanCheck c = check();
  for (const auto& p : c.problems) ADD_FAILURE() << p.step << ": " << p.message;
  EXPECT_TRUE(c.valid);
  EXPECT_TRUE(c.complete);
  ASSERT_EQ(c.step_penetration.size(), 2u);
  EXPECT_GT(c.max_penetration, 0);
  EXPECT_LE(c.max_penetration, 1e-3);
}

TEST_F(CheckPlan, APartialPlanIsValidAndNotComplete) {
  plan_.disassembly.pop_back();
  expect_problem(0, "says that it is complete");
  plan_.status = PlanStatus::partial;
  EXPECT_TRUE(check().valid);
  EXPECT_FALSE(check().complete);
}

TEST_F(CheckPlan, APlanIsCompleteWhenWhatItWasAskedForIsDone) {
  plan_.disassembly.pop_back();  // part1 and part2 are still together
  for (const PlanAsked& asked :
       {PlanAsked{.part = "part0"}, PlanAsked{.target = "part0"}, PlanAsked{.together = {{"part1", "part2"}}}}) {
    plan_.asked = asked;
    EXPECT_TRUE(check().valid);
    EXPECT_TRUE(check().complete);
  }
  plan_.asked = {.target = "part2"};
  expect_problem(0, "says that it is complete");
}

TEST_F(CheckPlan, GroupsLeaveTogetherAndAreTakenApartLater) {
  plan_.disassembly = {slide(1, {"part0", "part1"}, {{-4, 0, 0}, {-4, 0, 0}}, {{"part0", "part1"}})};
  EXPECT_FALSE(check().complete);
  PlanStep next;
  next.step = 2;
  next.moves.push_back({"part0", poses({0, 0, 4}, shift({-4, 0, 0}))});
  next.separates = {{"part0"}};
  plan_.disassembly.push_back(next);
  const PlanCheck c = check();
  for (const auto& p : c.problems) ADD_FAILURE() << p.step << ": " << p.message;
  EXPECT_TRUE(c.complete);
}

TEST_F(CheckPlan, SeveralGroupsMayLeaveInOneStep) {
  plan_.disassembly = {slide(1, {"part0", "part2"}, {{-4, 0, 0}, {4, 0, 0}}, {{"part0"}, {"part2"}})};
  EXPECT_TRUE(check().complete);
  plan_.disassembly[0].separates = {{"part0"}, {"part1"}, {"part2"}};
  EXPECT_TRUE(check().complete);
}

TEST_F(CheckPlan, RuleAStartsTravelAndNumbers) {
  const Plan good = plan_;
  plan_.disassembly[1].moves[0].poses.front().t.x() += 1;  // 0.01 assembly units
  expect_problem(2, "from where it is");
  plan_ = good;
  plan_.disassembly[0].moves[0].poses = poses({-4, 0, 0}, {}, 30);
  expect_problem(1, "more than 1 %");
  plan_ = good;
  plan_.disassembly[0].moves[0].poses = poses({-4, 0, 0}, {}, 40);  // 0.1 of 10: just allowed
  EXPECT_TRUE(check().valid);
  plan_.disassembly[1].step = 7;
  expect_problem(2, "numbered 7");
  plan_ = good;
  plan_.disassembly[0].moves[0].poses[3].q.coeffs() *= 1.01;
  expect_problem(1, "unit length");
  plan_ = good;
  plan_.disassembly[0].moves[0].poses[3].t.y() = std::numeric_limits<double>::quiet_NaN();
  expect_problem(1, "not finite");
  plan_ = good;
  plan_.disassembly[0].moves.push_back({"part1", poses({-1, 0, 0}, {}, 20)});
  expect_problem(1, "same number");
  plan_ = good;
  plan_.disassembly[0].moves[0].poses.resize(1);
  expect_problem(1, "less than two poses");
  plan_ = good;
  plan_.disassembly[0].moves.clear();
  expect_problem(1, "moves no part");
}

TEST_F(CheckPlan, RuleBCollisionsAreFoundAndNamed) {
  plan_.disassembly[0] = slide(1, {"part0"}, {{4, 0, 0}}, {{"part0"}});
  expect_problem(1, "penetrates 'part1'");
}

TEST_F(CheckPlan, AGroupThatIsOutIsNoObstacle) {
  PlanStep through = plan_.disassembly[1];
  through.moves[0].poses = poses({0, 4, 0});
  const auto on = poses({-12, 0, 0}, shift({0, 4, 0})), down = poses({0, -4, 0}, shift({-12, 4, 0}));
  through.moves[0].poses.insert(through.moves[0].poses.end(), on.begin() + 1, on.end());
  through.moves[0].poses.insert(through.moves[0].poses.end(), down.begin() + 1, down.end());  // into part0
  plan_.disassembly[1] = through;
  EXPECT_TRUE(check().valid);
}

TEST_F(CheckPlan, RuleCNotOutIsRefused) {
  plan_.disassembly[0].moves[0].poses = poses({0, 0, 1.9});
  expect_problem(1, "is not out");
  plan_.disassembly[0].moves[0].poses = poses({0, 0, 2.1});
  EXPECT_TRUE(check().valid);
}

TEST_F(CheckPlan, UnknownAndRepeatedNames) {
  const Plan good = plan_;
  plan_.disassembly[0].moves[0].part = "nobody";
  expect_problem(1, "'nobody' is not in the assembly");
  plan_ = good;
  plan_.disassembly[0].separates = {{"nobody"}};
  expect_problem(1, "'nobody', which is not in the assembly");
  plan_ = good;
  plan_.disassembly[1].separates = {{"part0"}};
  expect_problem(2, "not in the group any more");
  plan_ = good;
  plan_.disassembly[0].moves.push_back(plan_.disassembly[0].moves[0]);
  expect_problem(1, "two moves");
  plan_ = good;
  plan_.disassembly[0].separates = {{"part0", "part1", "part2"}};
  expect_problem(1, "whole group from nothing");
  plan_ = good;
  plan_.assembly.parts.pop_back();
  expect_problem(0, "'part2' of the assembly is not in the plan");
  plan_ = good;
  plan_.remaining = {"nobody"};
  expect_problem(0, "remaining");
  plan_ = good;
  plan_.disassembly.push_back(slide(3, {"part0", "part1"}, {{0, 0, 1}, {0, 0, 1}}, {}));
  expect_problem(3, "do not belong together");
}

TEST_F(CheckPlan, AssemblyStepsAreJudgedToo) {
  reverse_into_assembly();
  EXPECT_TRUE(check().complete);
  const Plan good = plan_;
  // A different path: part0 comes from below.
  plan_.assembly_steps[1].moves[0].poses = poses({0, 0, 6}, shift({0, 0, -6}));
  EXPECT_TRUE(check().valid);
  plan_.assembly_steps[1].moves[0].poses.pop_back();
  expect_problem(0, "not in its place");
  plan_ = good;
  plan_.assembly_steps[1].moves[0].poses = poses({-12, 0, 0}, shift({12, 0, 0}));  // through the others
  expect_problem(2, "assembly step");
  plan_ = good;
  plan_.assembly_steps.push_back(plan_.assembly_steps[1]);
  plan_.assembly_steps.back().step = 3;
  expect_problem(3, "from where it is");
}

TEST_F(CheckPlan, AReverseIsOneOfMotionsNotOfNumbers) {
  reverse_into_assembly();
  const Plan good = plan_;
  EXPECT_TRUE(check().complete);
  for (auto& step : plan_.assembly_steps)
    for (auto& pose : step.moves[0].poses) {
      pose.q.coeffs() *= -1;
      pose.t += Vec3::Constant(1e-8);  // 1e-10 assembly units
    }
  EXPECT_TRUE(check().complete);
  plan_ = good;
  std::swap(plan_.assembly_steps[0], plan_.assembly_steps[1]);  // a different order is checked anew
  plan_.assembly_steps[0].step = 1;
  plan_.assembly_steps[1].step = 2;
  EXPECT_TRUE(check().complete);
}

TEST_F(CheckPlan, AReverseCountsOnlyIfTheSamePartsStandBy) {
  // part0 moves up freely, since part2, which would block it, has left before.
  plan_.disassembly = {slide(1, {"part2"}, {{4, 0, 0}}, {{"part2"}}), slide(2, {"part1"}, {{4, 0, 0}}, {{"part1"}})};
  plan_.remaining = {"part0"};
  EXPECT_TRUE(check().complete);
  reverse_into_assembly();
  EXPECT_TRUE(check().complete);
  // The first step alone reverses the last disassembly step, but here part2 never left and blocks part1.
  plan_.assembly_steps[1].moves[0] = {"part1", {Pose{}, Pose{}}};
  expect_problem(1, "assembly step");
}

/// Both parts lie in a layout beside the rest, where each is an obstacle for the other.
TEST_F(CheckPlan, WhatLiesInTheLayoutIsInTheWay) {
  reverse_into_assembly();
  ASSERT_EQ(plan_.assembly_steps.size(), 2u);
  const auto bring = [&](std::size_t step, const Vec3& from) {  // straight to the start of the insertion
    auto& back = plan_.assembly_steps[step];
    const Pose start = assembly_.normalization.pose_to_internal(back.moves[0].poses.front());
    std::vector<Pose> path = poses(start.t - from, shift(from));
    path.pop_back();
    back.transfer = path.size();
    back.moves[0].poses.insert(back.moves[0].poses.begin(), path.begin(), path.end());
  };
  const Plan bare = plan_;
  const Vec3 first = bare_goal(0) + Vec3(0, 40, 0), second = bare_goal(1) + Vec3(0, -40, 0);
  bring(0, first);
  bring(1, second);
  plan_.assembly_status = AssemblyStatus::complete;
  for (const auto& p : check().problems) ADD_FAILURE() << p.step << ": " << p.message;
  EXPECT_TRUE(check().complete);
  const Plan good = plan_;

  // The second part lies on the path of the first.
  plan_ = bare;
  bring(0, first);
  bring(1, bare_goal(0) + Vec3(0, 20, 0) + (bare_place(0) - bare_place(1)));
  plan_.assembly_status = AssemblyStatus::complete;
  expect_problem(1, "assembly step");

  plan_ = good;
  plan_.assembly_steps[1].transfer = 0;
  expect_problem(0, "does not begin in the layout");
  plan_ = good;
  plan_.assembly_steps.pop_back();
  expect_problem(0, "has no assembly step for");
  plan_ = good;
  plan_.assembly_steps[0].transfer = plan_.assembly_steps[0].moves[0].poses.size();
  expect_problem(1, "beyond its poses");
}

TEST_F(CheckPlan, StopsWhenAsked) {
  RunContext context;
  context.cancel.cancel();
  const PlanCheck c = check_plan(plan_, assembly_, VerifyOptions{}, context);
  EXPECT_FALSE(c.valid);
  ASSERT_FALSE(c.problems.empty());
  EXPECT_NE(c.problems.back().message.find("stopped"), std::string::npos);
}

}  // namespace
}  // namespace dismantle
