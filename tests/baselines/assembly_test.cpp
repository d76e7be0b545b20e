// Algorithm 3 on whole plans: each part comes from the layout, ends in its place, and the verifier agrees.
#include <gtest/gtest.h>

#include <algorithm>

#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/samples/samples.h"
#include "dismantle/session/session.h"
#include "dismantle/testing/fake_planning.h"

namespace dismantle {
namespace {

using Settings = std::vector<std::string>;
using Eigen::Vector3d;

struct Planned {
  Assembly assembly;
  RunResult run;
};

Planned plan(const std::string& sample, const ParamSet& parameters, Settings set = {}, unsigned threads = 1) {
  set.insert(set.end(), {"simulator.type=fcl", "path_planner.type=mv_t_rrt", "run.path_timeout=0", "run.force=off"});
  if (std::none_of(set.begin(), set.end(), [](const std::string& s) { return s.starts_with("run.path_steps="); }))
    set.push_back("run.path_steps=100000");
  const Session session({{}, set, {}});
  RunContext context;
  context.threads = threads;
  const LoadedAssembly loaded =
      session.load(InputParts{samples::make(sample, parameters), "", {}, {}}, sample, context);
  return {*loaded.assembly, session.plan(loaded, context)};
}

void expect_valid(const Plan& plan, const Assembly& assembly) {
  RunContext context;
  const PlanCheck check = check_plan(plan, assembly, VerifyOptions{}, context);
  EXPECT_TRUE(check.valid);
  for (const auto& p : check.problems) ADD_FAILURE() << p.step << ": " << p.message;
}

std::string untimed(Plan plan) {
  for (auto& s : plan.disassembly) s.seconds = 0;
  for (auto& s : plan.assembly_steps) s.seconds = 0;
  for (auto& u : plan.unsolved) u.seconds = 0;
  return to_json(plan);
}

const PlanStep& step_of(const Plan& plan, const std::string& part) {
  for (const auto& s : plan.assembly_steps)
    if (s.moves.front().part == part) return s;
  throw std::logic_error("no step of " + part);
}

const ParamSet kBox = {{"count", std::int64_t{2}}, {"clearance", 0.5}};

TEST(AssemblySteps, LeadFromTheLayoutToTheAssembledState) {
  for (const auto& [sample, parameters] : std::vector<std::pair<std::string, ParamSet>>{
           {"stacked_box", kBox}, {"inclined_washer", {}}, {"l_slot", {{"clearance", 0.5}, {"travel", 10.0}}}}) {
    const auto [assembly, r] = plan(sample, parameters);
    ASSERT_EQ(r.plan.status, PlanStatus::complete) << sample;
    EXPECT_EQ(r.plan.assembly_status, AssemblyStatus::complete) << sample << ": " << r.plan.assembly_message;
    ASSERT_EQ(r.plan.assembly_steps.size(), r.plan.disassembly.size());
    const std::size_t n = r.plan.disassembly.size();
    for (std::size_t i = 0; i < n; ++i) {
      const PlanStep &back = r.plan.assembly_steps[i], &there = r.plan.disassembly[n - 1 - i];
      EXPECT_GT(back.transfer, 0u);
      ASSERT_EQ(back.moves[0].part, there.moves[0].part);
      // From `transfer` on it is the disassembly backwards, number for number, down to the assembled pose.
      ASSERT_EQ(back.moves[0].poses.size(), back.transfer + there.moves[0].poses.size());
      for (std::size_t k = 0; k < there.moves[0].poses.size(); ++k) {
        const Pose &a = there.moves[0].poses[there.moves[0].poses.size() - 1 - k],
                   &b = back.moves[0].poses[back.transfer + k];
        EXPECT_EQ(a.t, b.t);
        EXPECT_EQ(a.q.coeffs(), b.q.coeffs());
      }
      EXPECT_TRUE(back.moves[0].poses.back().is_identity(1e-12));
    }
    // What lies in the layout stands on the plane on which the assembly stands.
    for (const auto& back : r.plan.assembly_steps)
      for (const auto& part : assembly.parts)
        if (part.name == back.moves[0].part) {
          double lowest = 1e300;
          for (const auto& v : part.mesh->vertices)
            lowest = std::min(lowest, (back.moves[0].poses[0] * assembly.normalization.to_input(v)).z());
          EXPECT_NEAR(lowest, assembly.input_box.lo.z(), 1e-6) << sample << " " << part.name;
        }
    expect_valid(r.plan, assembly);
    expect_valid(plan_from_json(to_json(r.plan), "plan.json"), assembly);
  }
}

TEST(AssemblySteps, DependNeitherOnThreadsNorOnChance) {
  const std::string one = untimed(plan("stacked_box", kBox, {}, 1).run.plan);
  EXPECT_EQ(one, untimed(plan("stacked_box", kBox, {}, 2).run.plan));
}

TEST(AssemblySteps, TreesAloneDoItToo) {
  const auto [assembly, r] = plan("stacked_box", kBox, {"transfer_planner.straight_first=false"});
  EXPECT_EQ(r.plan.assembly_status, AssemblyStatus::complete) << r.plan.assembly_message;
  expect_valid(r.plan, assembly);
  const Settings set{"transfer_planner.straight_first=false"};
  EXPECT_EQ(untimed(r.plan), untimed(plan("stacked_box", kBox, set, 2).run.plan));
}

TEST(AssemblySteps, BeginWhereTheUserSays) {
  const auto [assembly, r] = plan(
      "stacked_box", kBox, {"layout.poses={lid: [0, 300, 0, 1, 0, 0, 0], plate_1: [300, 0, 0, 0.5, 0.5, 0.5, 0.5]}"});
  EXPECT_EQ(r.plan.assembly_status, AssemblyStatus::complete) << r.plan.assembly_message;
  const Pose lid = step_of(r.plan, "lid").moves[0].poses[0], plate = step_of(r.plan, "plate_1").moves[0].poses[0];
  EXPECT_LT((lid.t - Vector3d(0, 300, 0)).norm(), 1e-9);
  EXPECT_LT((plate.t - Vector3d(300, 0, 0)).norm(), 1e-9);
  EXPECT_LT(angle_between(plate.q, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5)), 1e-9);
  expect_valid(r.plan, assembly);
}

/// A part that the user puts where it cannot be: the disassembly stays complete, the assembly says what is wrong.
TEST(AssemblySteps, SayWhatIsImpossible) {
  const auto [assembly, r] = plan("stacked_box", kBox, {"layout.poses={lid: [0, 0, -3, 1, 0, 0, 0]}"});
  EXPECT_EQ(r.plan.status, PlanStatus::complete);
  EXPECT_EQ(r.plan.assembly_status, AssemblyStatus::partial);
  EXPECT_NE(r.plan.assembly_message.find("'lid'"), std::string::npos) << r.plan.assembly_message;
  EXPECT_EQ(r.plan.assembly_steps.size(), r.plan.disassembly.size());
  EXPECT_EQ(step_of(r.plan, "lid").transfer, 0u);
  EXPECT_GT(step_of(r.plan, "plate_1").transfer, 0u);
  expect_valid(r.plan, assembly);
}

TEST(AssemblySteps, NamesOfUnknownPartsAreErrors) {
  EXPECT_THROW(plan("stacked_box", kBox, {"layout.poses={lit: [0, 300, 0, 1, 0, 0, 0]}"}), InputError);
}

TEST(AssemblySteps, PosesOfTheWrongFormAreErrors) {
  for (const char* poses :
       {"[1, 2]", "{lid: [1, 2]}", "{lid: 3}", "{lid: [0, 0, 0, 2, 0, 0, 0]}", "{lid: [0, 0, 0, a, 0, 0, 0]}"}) {
    EXPECT_THROW(Session({{}, {std::string("layout.poses=") + poses}, {}}), ConfigError) << poses;
  }
}

TEST(AssemblySteps, AreTheDisassemblyBackwardsWithoutALayout) {
  const auto [assembly, r] = plan("stacked_box", kBox, {"layout.enabled=false"});
  EXPECT_EQ(r.plan.assembly_status, AssemblyStatus::reversed);
  for (const auto& s : r.plan.assembly_steps) EXPECT_EQ(s.transfer, 0u);
  expect_valid(r.plan, assembly);
}

TEST(AssemblySteps, PartsThatStayHaveNone) {
  const auto [assembly, r] = plan("closed_box", {}, {"run.path_steps=300", "sequence_planner.type=queue"});
  EXPECT_TRUE(r.plan.assembly_steps.empty());
  expect_valid(r.plan, assembly);
}

/// Takes the two upper blocks out of the tube together, then one off the other, then the third.
class PairFirst final : public SequencePlanner {
 public:
  SequenceResult plan(const SequenceQuery&, PathOracle& oracle, SequenceObserver& observer, RunContext& context) override {
    SequenceResult result;
    result.outcome = Outcome::solved;
    std::vector<Pose> at(4);
    const auto take = [&](const std::vector<PartId>& moving, const std::vector<PartId>& fixed) {
      Attempt attempt;
      for (const PartId id : moving) attempt.moving.push_back({id, at[id]});
      for (const PartId id : fixed) attempt.fixed.push_back({id, at[id]});
      const AttemptResult& answer = oracle.attempt(attempt, context);
      ASSERT_TRUE(is_success(answer.result.outcome())) << answer.result.message;
      result.removals.push_back({moving, &answer});
      observer.removed(result.removals.back(), 0);
      for (std::size_t k = 0; k < moving.size(); ++k) at[moving[k]] = answer.result.path()->poses().back()[k];
    };
    take({2, 3}, {0, 1});
    take({3}, {2});
    take({1}, {0});
    return result;
  }
};

/// A group that left as a whole is put together at a place of its own, and moves in as a whole.
TEST(AssemblySteps, SubAssembliesArePutTogetherFirst) {
  Registry registry;
  registry.scan();
  const Assembly assembly = fake::tube_with_blocks(3);
  PlanningSetup setup = fake::setup(fake::push, std::make_shared<PairFirst>());
  setup.transfer_planner = [&] { return registry.create<TransferPlanner>("rrt_connect"); };
  setup.transfer_planner_id = "rrt_connect";
  RunContext context;
  const Plan plan = run(assembly, setup, RunOptions{}, context).plan;
  ASSERT_EQ(plan.status, PlanStatus::complete);
  ASSERT_EQ(plan.assembly_status, AssemblyStatus::complete) << plan.assembly_message;
  ASSERT_EQ(plan.assembly_steps.size(), 3u);
  EXPECT_EQ(plan.assembly_steps[0].moves[0].part, "block1");
  EXPECT_EQ(plan.assembly_steps[1].moves[0].part, "block3");
  ASSERT_EQ(plan.assembly_steps[2].moves.size(), 2u);
  // block3 joins block2 where that lies, beside the tube, not where the disassembly left it.
  const Pose lies = plan.assembly_steps[2].moves[0].poses.front();
  EXPECT_GT(std::max(std::abs(lies.t.x()), std::abs(lies.t.y())), 2.0);
  for (const auto& move : plan.assembly_steps[2].moves) EXPECT_TRUE(move.poses.back().is_identity(1e-9));
  expect_valid(plan, assembly);
}

}  // namespace
}  // namespace dismantle
