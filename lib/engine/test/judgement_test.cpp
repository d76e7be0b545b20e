// The steps of a run are judged as assembly operations, by the checks of the objective; a plan is judged again the same
// way.
#include "dismantle/engine/judgement.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "dismantle/plan_io/plan_file.h"
#include "dismantle/testing/run_rig.h"

namespace dismantle {
namespace {

/// A check that is one function.
class Scripted final : public StepCheck {
 public:
  using Judge = std::function<StepVerdict(const StepQuestion&)>;
  explicit Scripted(Judge judge, bool whole = false) : judge_(std::move(judge)), whole_(whole) {}
  StepCheckTraits traits() const noexcept override { return {.remembers_shape = true, .judges_plan = whole_}; }
  StepVerdict judge(const StepQuestion& question, const RunContext&) const override { return judge_(question); }
  StepVerdict judge_plan(std::span<const StepQuestion> operations, const RunContext&) const override {
    return {.cost = static_cast<double>(operations.size()), .reason = "its steps"};
  }

 private:
  Judge judge_;
  bool whole_;
};

Objective objective_of(Scripted::Judge judge, double weight = 1, bool whole = false) {
  return {{{"scripted", std::make_shared<Scripted>(std::move(judge), whole), weight, false, {{"x", 1.5}}}}};
}

/// Three blocks leave a tube upwards, the highest first.
RunResult run_with(const Objective& objective, RunContext context = {}) {
  const Assembly assembly = fake::tube_with_blocks(3);
  PlanningSetup setup = fake::setup(fake::push_blocks, std::make_shared<fake::InTurn>());
  setup.objective = objective;
  return run(assembly, setup, RunOptions{}, context);
}

std::vector<PartId> ids(std::span<const PlacedPart> parts) {
  std::vector<PartId> out;
  for (const PlacedPart& p : parts) out.push_back(p.part);
  return out;
}

TEST(Judgement, QuestionsAreTheOperationsInTheOrderOfAssembly) {
  struct Asked {
    std::vector<PartId> moving, present, before;
    Eigen::Vector3d direction;
    std::size_t instants;
  };
  std::vector<Asked> asked;
  run_with(objective_of([&](const StepQuestion& q) {
    EXPECT_EQ(q.up, Eigen::Vector3d::UnitZ());
    EXPECT_TRUE(q.previous == nullptr || q.previous->previous == nullptr);
    EXPECT_EQ(q.path->back().front().t, Eigen::Vector3d::Zero()) << "it ends where the part belongs";
    asked.push_back({ids(q.moving), ids(q.present),
                     q.previous == nullptr ? std::vector<PartId>{} : ids(q.previous->moving), q.direction,
                     q.path->size()});
    return StepVerdict{};
  }));
  ASSERT_EQ(asked.size(), 3u);
  std::set<std::vector<PartId>> seen;
  for (const Asked& a : asked) {
    ASSERT_EQ(a.moving.size(), 1u);
    const PartId part = a.moving.front();
    seen.insert(a.moving);
    std::vector<PartId> lower;
    for (PartId id = 0; id < part; ++id) lower.push_back(id);
    EXPECT_EQ(a.present, lower) << "the tube and the blocks below";
    EXPECT_EQ(a.before, part == 1 ? std::vector<PartId>{} : std::vector<PartId>{part - 1});
    EXPECT_NEAR((a.direction + Eigen::Vector3d::UnitZ()).norm(), 0, 1e-12) << "downwards";
    EXPECT_GE(a.instants, 2u);
  }
  EXPECT_EQ(seen.size(), 3u);
}

/// Parts of any groups move, stay and leave. A check of the whole plan is asked about the same operations as step by
/// step; what is present may be in another order.
TEST(Judgement, AWholePlanHasTheOperationsOfItsSteps) {
  struct Seen {
    std::map<PartId, Pose> moving, present;
    std::optional<PartId> before;
    Eigen::Vector3d direction;
    bool operator==(const Seen&) const = default;
  };
  class Watch final : public StepCheck {
   public:
    mutable std::vector<Seen> steps, whole;
    StepCheckTraits traits() const noexcept override { return {.remembers_shape = true, .judges_plan = true}; }
    StepVerdict judge(const StepQuestion& q, const RunContext&) const override {
      steps.push_back(seen(q));
      EXPECT_TRUE(std::ranges::is_sorted(ids(q.present)));
      return {};
    }
    StepVerdict judge_plan(std::span<const StepQuestion> all, const RunContext&) const override {
      for (const StepQuestion& q : all) whole.push_back(seen(q));
      return {};
    }
    static Seen seen(const StepQuestion& q) {
      Seen s{{}, {}, std::nullopt, q.direction};
      for (const PlacedPart& p : q.moving) s.moving[p.part] = p.pose;
      for (const PlacedPart& p : q.present) s.present[p.part] = p.pose;
      if (q.previous != nullptr) s.before = q.previous->moving.front().part;
      return s;
    }
  };
  Rng rng(58);
  for (int trial = 0; trial < 30; ++trial) {
    const Assembly assembly = fake::row(7);
    Disassembly done(assembly.parts.size());
    for (int tries = 0; tries < 12; ++tries) {
      const std::vector<PartId>& group = done.groups()[rng.below(done.groups().size())];
      if (group.size() < 2) continue;
      DisassemblyStep step;
      for (const PartId id : group)
        if (step.parts.size() + 1 < group.size() && rng.below(2) == 0) step.parts.push_back(id);
      if (step.parts.empty()) step.parts = {group.front()};
      const std::uint64_t kind = rng.below(4);
      step.placement = kind == 0;
      if (kind == 1 && step.parts.size() > 1) step.released = step.parts.back();
      Path path(2);
      const Eigen::Vector3d shift(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
      for (const PartId id : step.parts) {
        path[0].push_back(done.pose(id));
        path[1].push_back({done.pose(id).t + shift, done.pose(id).q});
      }
      step.path = std::make_shared<const Path>(std::move(path));
      done.add(std::move(step));
    }
    Plan plan;
    plan.disassembly.resize(done.steps().size());
    const auto watch = std::make_shared<Watch>();
    judge(plan, done, assembly, {{{"watch", watch, 1, false, {}}}}, RunContext{});
    ASSERT_EQ(watch->steps.size(), done.steps().size());
    EXPECT_EQ(watch->steps, watch->whole) << trial;
    for (std::size_t k = 0; k < done.steps().size(); ++k) {
      const Operation alone = operation_of(done, k, assembly, Objective{}.up);
      const Seen expected = Watch::seen(alone.question()), &got = watch->steps[done.steps().size() - 1 - k];
      EXPECT_EQ(got.moving, expected.moving);
      EXPECT_EQ(got.present, expected.present);
      EXPECT_EQ(got.direction, expected.direction);
    }
  }
}

TEST(Judgement, ThePlanStatesVerdictsAndSums) {
  const StepNote note{"hold", "Hold it.", R"({"b":1.0,"a":[]})"};
  const Plan plan = run_with(objective_of(
                                 [&](const StepQuestion& q) {
                                   const PartId part = q.moving.front().part;
                                   StepVerdict v{part != 2, 1.0 * part, "part " + std::to_string(part)};
                                   if (part == 3) v.notes = {note};
                                   return v;
                                 },
                                 0.5, true))
                        .plan;
  ASSERT_EQ(plan.objective.checks.size(), 1u);
  const PlanObjectiveItem& item = plan.objective.checks[0];
  EXPECT_EQ(item.type, "scripted");
  EXPECT_EQ(item.parameters, (ParamSet{{"x", 1.5}}));
  ASSERT_TRUE(item.plan);
  EXPECT_EQ(item.plan->cost, 3);
  EXPECT_EQ(item.cost, 1 + 2 + 3 + 3);
  EXPECT_EQ(plan.objective.cost, 0.5 * item.cost);
  ASSERT_EQ(plan.disassembly.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_EQ(plan.disassembly[k].checks.size(), 1u);
    const PlanVerdict& v = plan.disassembly[k].checks[0];
    EXPECT_EQ(v.cost, 3.0 - static_cast<double>(k)) << "block 3 leaves first";
    EXPECT_EQ(v.allowed, k != 1);
    EXPECT_EQ(v.weight, 0.5);
  }
  EXPECT_EQ(plan.disassembly[0].checks[0].notes, (std::vector<StepNote>{note}));
  for (const PlanStep& step : plan.assembly_steps) EXPECT_TRUE(step.checks.empty());
}

TEST(Judgement, WithoutAnObjectiveThePlanStaysAsItIs) {
  const Plan plan = run_with({}).plan;
  EXPECT_TRUE(plan.objective.empty());
  for (const PlanStep& step : plan.disassembly) EXPECT_TRUE(step.checks.empty());
}

// Law: whatever a check does, the plan can be written, says that it failed, and the log does.
TEST(Judgement, ACheckThatFailsIsNoVerdict) {
  const std::pair<Scripted::Judge, std::string> broken[] = {
      {[](const StepQuestion&) -> StepVerdict { throw std::runtime_error("no luck"); }, "no luck"},
      {[](const StepQuestion&) { return StepVerdict{.cost = -1, .reason = "r"}; }, "not a number from 0 on"},
      {[](const StepQuestion&) { return StepVerdict{.cost = std::nan(""), .reason = "r"}; }, "not a number from 0 on"},
      {[](const StepQuestion&) {
         StepVerdict v;
         v.notes = {{"k", "t", "[1]"}};
         return v;
       },
       "the data of the note 'k' is not a JSON object"},
      {[](const StepQuestion&) {
         StepVerdict v;
         v.notes = {{"", "t", ""}};
         return v;
       },
       "a note has no kind"}};
  for (const auto& [judge, text] : broken) {
    std::vector<std::string> errors;
    RunContext context;
    context.on_log = [&](LogLevel level, std::string_view said) {
      if (level == LogLevel::error) errors.emplace_back(said);
    };
    const Plan plan = run_with(objective_of(judge), context).plan;
    ASSERT_EQ(plan.disassembly.size(), 3u);
    for (const PlanStep& step : plan.disassembly) {
      EXPECT_NE(step.checks.at(0).failed.find(text), std::string::npos) << step.checks.at(0).failed;
      EXPECT_EQ(step.checks.at(0).cost, 0);
      EXPECT_TRUE(step.checks.at(0).notes.empty());
    }
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_NE(errors[0].find("'scripted'"), std::string::npos) << errors[0];
    EXPECT_EQ(to_json(plan_from_json(to_json(plan), "p")), to_json(plan));
  }
}

/// Judges the plan again as it is after writing and reading.
PlanCheck again(const Plan& plan, const CheckOfType& check_of_type) {
  PlanCheck check;
  check.valid = true;
  judge_again(check, plan_from_json(to_json(plan), "p"), fake::tube_with_blocks(3), check_of_type, RunContext{});
  return check;
}

StepVerdict by_height(const StepQuestion& q) {
  const double height = q.assembly.parts[q.moving.front().part].mesh->box().center().z();
  return {q.moving.front().part != 2, height + (q.previous == nullptr ? 0.25 : 0), "height"};
}

TEST(Judgement, AgainIsTheSame) {
  const Objective objective = objective_of(by_height, 2, true);
  const Plan plan = run_with(objective).plan;
  const PlanCheck check = again(plan, [&](const std::string& type, const ParamSet& parameters) {
    EXPECT_EQ(type, "scripted");
    EXPECT_EQ(parameters, (ParamSet{{"x", 1.5}}));
    return objective.items[0].check;
  });
  EXPECT_EQ(check.verdicts, 3u);
  EXPECT_TRUE(check.valid && check.problems.empty()) << check.problems.front().message;
  EXPECT_TRUE(check.not_checked.empty());
}

TEST(Judgement, WhatIsStatedWronglyIsFound) {
  const Objective objective = objective_of(by_height, 2, true);
  const Plan right = run_with(objective).plan;
  const auto expect = [&](const std::function<void(Plan&)>& change, const std::string& said) {
    Plan plan = right;
    change(plan);
    const PlanCheck check = again(plan, [&](const auto&, const auto&) { return objective.items[0].check; });
    ASSERT_FALSE(check.problems.empty()) << said;
    EXPECT_FALSE(check.valid);
    const std::string text = fmt::format("step {}: {}", check.problems.front().step, check.problems.front().message);
    EXPECT_NE(text.find(said), std::string::npos) << text;
  };
  const auto shift = [](Plan& p, double by) {
    p.disassembly[1].checks[0].cost += by;
    p.objective.checks[0].cost += by;
    p.objective.cost += 2 * by;
  };
  expect([&](Plan& p) { shift(p, 0.5); }, "step 2: 'scripted': the plan says that it costs");
  expect([](Plan& p) { p.disassembly[1].checks[0].allowed = true; }, "step 2: 'scripted': the plan says allowed");
  expect([](Plan& p) { p.disassembly[2].checks[0].failed = "x"; },
         "step 3: 'scripted': the plan says that the check failed");
  expect([](Plan& p) { p.objective.checks[0].cost += 1; }, "objective: 'scripted' costs");
  expect([](Plan& p) { p.objective.cost += 1; }, "objective: the sum is");
  expect(
      [](Plan& p) {
        p.objective.checks[0].plan.reset();
        p.objective.checks[0].cost -= 3;
        p.objective.cost -= 6;
      },
      "'scripted' judges the plan as a whole");
  expect([](Plan& p) { p.disassembly[0].checks.clear(); }, "step 1: its checks are not those of the objective");
  expect([](Plan& p) { p.objective = {}; }, "step 1: its checks are not those of the objective");
}

TEST(Judgement, ACheckThatIsNotThereIsNotChecked) {
  const Plan plan = run_with(objective_of(by_height)).plan;
  const PlanCheck check = again(plan, [](const auto&, const auto&) -> std::shared_ptr<const StepCheck> {
    throw std::runtime_error("no such plugin");
  });
  EXPECT_EQ(check.verdicts, 0u);
  EXPECT_TRUE(check.problems.empty());
  ASSERT_EQ(check.not_checked.size(), 1u);
  EXPECT_EQ(check.not_checked[0], "'scripted': no such plugin");
}

}  // namespace
}  // namespace dismantle
