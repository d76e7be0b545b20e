// Runs that start from other arrangements than the assembled one: a half-finished plan, or some of the parts.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "dismantle/errors.h"
#include "dismantle/testing/run_rig.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {
namespace {

using fake::InTurn;

/// Takes every group of the start apart.
class EachGroup final : public SequencePlanner {
 public:
  SequencePlannerTraits traits() const noexcept override { return {.any_start = true}; }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override {
    SequenceResult all;
    all.outcome = Outcome::solved;
    for (const auto& group : query.start) {
      const SequenceResult one =
          InTurn().plan({query.assembly, {group}, query.constraints, query.objective}, oracle, observer, context);
      if (!is_success(one.outcome)) all.outcome = one.outcome;
      all.unsolved.insert(all.unsolved.end(), one.unsolved.begin(), one.unsolved.end());
    }
    return all;
  }
};

RunResult run_each(const Assembly& assembly, const RunOptions& options, const StepObserver& on_step = {}) {
  RunContext context;
  return run(assembly, fake::setup(fake::push_blocks, std::make_shared<EachGroup>()), options, context, on_step);
}

void expect_valid(const Plan& plan, const Assembly& assembly) {
  RunContext context;
  const PlanCheck check = check_plan(plan, assembly, VerifyOptions{}, context);
  EXPECT_TRUE(check.valid) << (check.problems.empty() ? "" : check.problems.front().message);
}

TEST(Start, APlanGoesOnFromAnyOfItsSteps) {
  for (const unsigned n : {1u, 3u, 5u}) {
    const Assembly assembly = fake::tube_with_blocks(n);
    const Plan whole = run_each(assembly, {}).plan;
    ASSERT_EQ(whole.status, PlanStatus::complete);
    for (std::size_t count = 0; count <= n; ++count) {
      RunOptions options;
      options.resume = disassembly_of(whole, assembly, count);
      EXPECT_EQ(options.resume->steps().size(), count);
      std::vector<std::size_t> seen;
      const RunResult r = run_each(assembly, options, [&](const Disassembly& so_far, const DisassemblyStep& newest) {
        seen.push_back(so_far.steps().size());
        EXPECT_EQ(newest.parts, so_far.steps().back().parts);
      });
      EXPECT_EQ(r.outcome, Outcome::solved);
      EXPECT_EQ(fake::text_without_times(r.plan), fake::text_without_times(whole)) << count;
      EXPECT_EQ(seen.size(), n) << "earlier steps are recorded like new ones";
      expect_valid(r.plan, assembly);
    }
  }
}

TEST(Start, AStepThatIsNotValidIsRefused) {
  const Assembly assembly = fake::tube_with_blocks(2);
  Plan plan = run_each(assembly, {}).plan;
  Plan sideways = plan;
  for (PlanMove& move : sideways.disassembly.front().moves)
    for (std::size_t i = 1; i < move.poses.size(); ++i) move.poses[i].t = {2.0 * static_cast<double>(i), 0, 0};
  RunOptions options;
  options.resume = disassembly_of(sideways, assembly);
  EXPECT_THROW(run_each(assembly, options), InputError);

  Plan unknown = plan;
  unknown.disassembly.front().moves.front().part = "nobody";
  EXPECT_THROW(disassembly_of(unknown, assembly), InputError);
  Plan twice = plan;
  twice.disassembly.insert(twice.disassembly.begin(), twice.disassembly.front());
  EXPECT_THROW(disassembly_of(twice, assembly), InputError);
}

TEST(Start, APlannerThatNeedsTheWholeAssemblyIsRefused) {
  const Assembly assembly = fake::row(3);
  RunOptions options;
  options.resume = Disassembly(3);
  RunContext context;
  const auto nothing = [](const Assembly&, PathOracle&, SequenceObserver&, RunContext&) { return SequenceResult{}; };
  EXPECT_THROW(run(assembly, fake::setup(fake::push, std::make_shared<fake::Custom>(nothing)), options, context),
               std::invalid_argument);
}

/// The parts outside of the start are absent: they are no obstacles, and the plan says nothing about them.
TEST(Start, SomePartsArePlannedAlone) {
  const Assembly assembly = fake::tube_with_blocks(4);
  RunOptions options;
  options.start = {{{0, Pose{}}, {1, Pose{}}, {2, Pose{}}}};  // the two upper blocks are not there
  const RunResult r = run_each(assembly, options);
  EXPECT_EQ(r.outcome, Outcome::solved);
  ASSERT_EQ(r.disassembly.steps().size(), 2u);
  EXPECT_EQ(r.disassembly.steps().front().parts, (std::vector<PartId>{2}));
  EXPECT_EQ(r.disassembly.group(3), Disassembly::kAbsent);
}

TEST(Start, SeveralGroupsAtOtherPlacesArePlannedInOneRun) {
  const Assembly assembly = fake::row(4);
  const Pose up{{0, 0, 40}, Eigen::Quaterniond::Identity()};
  RunOptions options;
  options.start = {{{0, Pose{}}, {1, Pose{}}}, {{2, up}, {3, up}}};
  RunContext context;
  const RunResult r = run(assembly, fake::setup(fake::push, std::make_shared<EachGroup>()), options, context);
  EXPECT_EQ(r.outcome, Outcome::solved);
  ASSERT_EQ(r.disassembly.steps().size(), 2u);
  EXPECT_EQ(r.disassembly.pose(r.disassembly.steps().back().parts.front(), 0), up);
}

}  // namespace
}  // namespace dismantle
