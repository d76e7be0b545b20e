// Laws of all step checks with default parameters.
#include "dismantle/step_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <string>
#include <thread>
#include <vector>

#include "dismantle/engine/judgement.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/testing/run_rig.h"
#include "small_assemblies.h"

namespace dismantle::contract {
namespace {

/// Operations of one assembly, in the order of assembly, with straight and bent paths in random directions.
std::deque<Operation> random_operations(const Assembly& assembly, Rng& rng) {
  std::deque<Operation> all;
  std::vector<PlacedPart> present;
  const auto random_vector = [&rng] { return Vector3d(rng.normal(), rng.normal(), rng.normal()); };
  for (PartId next = 0; next < assembly.parts.size();) {
    std::vector<PlacedPart> moved;
    for (auto n = 1 + rng.below(2); n > 0 && next < assembly.parts.size(); --n) moved.push_back({next++, Pose{}});
    Trace removal(2 + rng.below(3));
    Vector3d displacement = Vector3d::Zero();
    for (auto& instant : removal) {
      for (const PlacedPart& p : moved) instant.push_back(Pose{p.pose.t + displacement, p.pose.q});
      displacement += rng.below(3) == 0 ? Vector3d(Vector3d::Unit(static_cast<int>(rng.below(3)))) : random_vector();
    }
    all.emplace_back(assembly, moved, present, std::move(removal), random_vector().normalized());
    present.insert(present.end(), moved.begin(), moved.end());
  }
  return all;
}

/// Boxes of few different sizes, some of them copies of others.
Assembly random_boxes(Rng& rng) {
  std::vector<Mesh> meshes;
  for (auto n = 2 + rng.below(8); n > 0; --n) {
    const Vector3d corner(rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(-3, 3));
    meshes.push_back(shapes::box(corner, corner + Vector3d(1, 1, 1.0 + static_cast<double>(rng.below(3)))));
  }
  return shapes::assembly_of(meshes);
}

void expect_same(const StepVerdict& a, const StepVerdict& b, const std::string& what) {
  EXPECT_EQ(a.allowed, b.allowed) << what;
  EXPECT_EQ(a.cost, b.cost) << what;
  EXPECT_EQ(a.reason, b.reason) << what;
  EXPECT_EQ(a.notes, b.notes) << what;
  ASSERT_EQ(a.certificate.has_value(), b.certificate.has_value()) << what;
  if (a.certificate) {
    EXPECT_EQ(a.certificate->numbers, b.certificate->numbers) << what;
  }
}

class StepCheckContract : public testing::TestWithParam<std::string> {
 protected:
  static std::shared_ptr<const StepCheck> make() { return registry().create<StepCheck>(GetParam()); }

  /// Calls f(question) for many operations, each with the one before it.
  template <class F>
  static void for_each_question(F f) {
    Rng rng(77);
    std::vector<Assembly> assemblies;
    for (const Small& small : small_assemblies()) assemblies.push_back(small.assembly);
    for (int k = 0; k < 20; ++k) assemblies.push_back(random_boxes(rng));
    for (const Assembly& assembly : assemblies) {
      const std::deque<Operation> operations = random_operations(assembly, rng);
      for (std::size_t k = 0; k < operations.size(); ++k) {
        const StepQuestion previous = operations[k == 0 ? 0 : k - 1].question();
        f(operations[k].question(k == 0 ? nullptr : &previous));
      }
    }
  }
};

TEST_P(StepCheckContract, DeclaresItsParametersInFull) {
  const PluginType& type = registry().find(PluginKind::step_check, GetParam()).type;
  EXPECT_TRUE(problems_of_schema(type.params).empty());
  EXPECT_FALSE(type.summary.empty());
}

TEST_P(StepCheckContract, SaysWhy) {
  const auto check = make();
  for_each_question([&](const StepQuestion& question) {
    const StepVerdict verdict = check->judge(question, RunContext{});
    EXPECT_TRUE(std::isfinite(verdict.cost) && verdict.cost >= 0) << verdict.cost;
    EXPECT_TRUE(!verdict.reason.empty() || (verdict.allowed && verdict.cost == 0))
        << "a cost or a refusal has a reason";
    for (const StepNote& note : verdict.notes) {
      EXPECT_FALSE(note.kind.empty());
      EXPECT_FALSE(note.text.empty());
    }
  });
}

TEST_P(StepCheckContract, SameVerdictAgainAndOnAnyNumberOfThreads) {
  const auto check = make();
  for_each_question([&](const StepQuestion& question) {
    const StepVerdict once = check->judge(question, RunContext{});
    expect_same(once, check->judge(question, RunContext{}), "again");
    expect_same(once, make()->judge(question, RunContext{}), "by another object");
    std::vector<StepVerdict> verdicts(3);
    std::vector<std::thread> threads;
    for (StepVerdict& verdict : verdicts) threads.emplace_back([&] { verdict = check->judge(question, RunContext{}); });
    for (std::thread& thread : threads) thread.join();
    for (const StepVerdict& verdict : verdicts) expect_same(once, verdict, "on another thread");
  });
}

TEST_P(StepCheckContract, ReadsNoMoreOfTheStepBeforeThanItsTraitsSay) {
  const auto check = make();
  const StepCheckTraits traits = check->traits();
  Rng rng(78);
  for_each_question([&](const StepQuestion& question) {
    if (question.previous == nullptr) return;
    const StepVerdict verdict = check->judge(question, RunContext{});
    // Everything that is not remembered is replaced.
    StepQuestion previous = *question.previous;
    const Vector3d other = Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    if (!traits.remembers_direction) previous.direction = other;
    if (!traits.remembers_orientation) previous.up = other;
    if (!traits.remembers_shape) previous.moving = question.moving;
    const std::span<const PlacedPart> none;
    for (const auto present : {none, question.present}) {
      previous.present = present;
      previous.path = nullptr;
      StepQuestion asked = question;
      asked.previous = &previous;
      expect_same(verdict, check->judge(asked, RunContext{}), "another step before");
    }
    if (traits.remembers_direction || traits.remembers_orientation || traits.remembers_shape) return;
    StepQuestion alone = question;
    alone.previous = nullptr;
    expect_same(verdict, check->judge(alone, RunContext{}), "no step before");
  });
}

TEST_P(StepCheckContract, ReadsNoMoreOfTheStepThanItsTraitsSay) {
  const auto check = make();
  const StepCheckTraits traits = check->traits();
  for_each_question([&](const StepQuestion& question) {
    const StepVerdict verdict = check->judge(question, RunContext{});
    StepQuestion asked = question;
    if (!traits.reads_present) asked.present = {};
    if (!traits.reads_path) asked.path = nullptr;
    expect_same(verdict, check->judge(asked, RunContext{}), "without what it does not read");
  });
}

TEST_P(StepCheckContract, ThePathMayBeUnknown) {
  const auto check = make();
  for_each_question([&](const StepQuestion& question) {
    StepQuestion asked = question;
    asked.path = nullptr;
    const StepVerdict once = check->judge(asked, RunContext{});
    EXPECT_TRUE(std::isfinite(once.cost) && once.cost >= 0) << once.cost;
    expect_same(once, check->judge(asked, RunContext{}), "again");
  });
}

TEST_P(StepCheckContract, JudgesAPlanAsAWholeOnlyIfItSaysSo) {
  const auto check = make();
  Rng rng(79);
  for (int trial = 0; trial < 20; ++trial) {
    const Assembly assembly = random_boxes(rng);
    const std::deque<Operation> operations = random_operations(assembly, rng);
    std::vector<StepQuestion> questions;
    for (const Operation& operation : operations) questions.push_back(operation.question());
    const StepVerdict once = check->judge_plan(questions, RunContext{});
    EXPECT_TRUE(std::isfinite(once.cost) && once.cost >= 0) << once.cost;
    if (!check->traits().judges_plan) expect_same(once, StepVerdict{}, "it does not judge plans");
    expect_same(once, make()->judge_plan(questions, RunContext{}), "by another object");
  }
}

// A run judges what a reader of its plan file judges, and what the check says survives writing and reading.
TEST_P(StepCheckContract, SameVerdictFromPlanAndVerify) {
  for (const Assembly& assembly : {fake::tube_with_blocks(4), fake::row(5)}) {
    PlanningSetup setup = fake::setup(fake::push, std::make_shared<fake::InTurn>());
    setup.objective.items.push_back({GetParam(), make()});
    RunContext context;
    const Plan plan = run(assembly, setup, RunOptions{}, context).plan;
    ASSERT_GE(plan.disassembly.size(), 3u);
    const std::string text = to_json(plan);
    const Plan read = plan_from_json(text, "plan.json");
    EXPECT_EQ(to_json(read), text);
    for (std::size_t k = 0; k < plan.disassembly.size(); ++k) {
      const PlanVerdict &said = plan.disassembly[k].checks.at(0), &again = read.disassembly[k].checks.at(0);
      EXPECT_EQ(said.failed, "");
      EXPECT_EQ(said.notes, again.notes);
      EXPECT_EQ(said.reason, again.reason);
    }
    PlanCheck check;
    check.valid = true;
    judge_again(
        check, read, assembly, [](const std::string&, const ParamSet&) { return make(); }, context);
    for (const PlanProblem& problem : check.problems)
      ADD_FAILURE() << "step " << problem.step << ": " << problem.message;
    EXPECT_EQ(check.verdicts, plan.disassembly.size());
    EXPECT_TRUE(check.not_checked.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Registered, StepCheckContract, testing::ValuesIn(ids(PluginKind::step_check)), test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(StepCheckContract);

}  // namespace
}  // namespace dismantle::contract
