// Laws: each baseline solves what a planner of its kind should, alone and under each sequence planner; the same seed
// gives the same plan on any number of threads; planners that need dynamics are not to be combined with `fcl`.
#include <gtest/gtest.h>

#include <algorithm>

#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/samples/samples.h"
#include "dismantle/session/session.h"

namespace dismantle {
namespace {

using Settings = std::vector<std::string>;

Session session_of(const std::string& planner, const std::string& simulator, Settings set) {
  set.insert(set.end(), {"simulator.type=" + simulator, "path_planner.type=" + planner, "run.path_timeout=0",
                         "run.force=off", "layout.enabled=false"});
  return Session({{}, set, {}});
}

/// The simulator that a planner is meant for.
std::string home_of(const std::string& planner) { return planner == "bk_rrt" ? "sdf_penalty" : "fcl"; }

RunResult plan(const std::string& sample, const ParamSet& parameters, const std::string& planner, const Settings& set,
               unsigned threads = 1) {
  const Session session = session_of(planner, home_of(planner), set);
  RunContext context;
  context.threads = threads;
  return session.plan(session.load(InputParts{samples::make(sample, parameters), "", {}, {}}, sample, context), context);
}

/// Blocked parts shall not cost a test much.
Settings brief(const std::string& planner, const std::string& steps) {
  return {"run.path_steps=" + steps,
          planner == "bk_rrt" ? "path_planner.level_steps=2000" : "path_planner.level_checks=300"};
}

const ParamSet kSmallBox = {{"count", std::int64_t{1}}, {"clearance", 0.5}, {"size", 20.0}};

class EachPlanner : public ::testing::TestWithParam<const char*> {};
/// A roadmap spends its work everywhere, and does not get round a bend in a close fit with this budget.
class EachButRoadmaps : public EachPlanner {};

TEST_P(EachPlanner, SolvesPegWithGenerousClearance) {
  const RunResult r =
      plan("peg_in_hole", {{"clearance", 0.5}, {"size", 10.0}, {"length", 12.0}, {"segments", std::int64_t{16}}},
           GetParam(), {"run.path_steps=200000"});
  EXPECT_EQ(r.plan.status, PlanStatus::complete);
}

TEST_P(EachPlanner, SolvesBoxWithLid) {
  const RunResult r =
      plan("stacked_box", {{"count", std::int64_t{1}}, {"clearance", 0.5}}, GetParam(), brief(GetParam(), "200000"));
  EXPECT_EQ(r.plan.status, PlanStatus::complete);
}

TEST_P(EachButRoadmaps, SolvesSlotWithOneBend) {
  const RunResult r = plan("l_slot", {{"clearance", 0.5}, {"travel", 10.0}}, GetParam(), {"run.path_steps=1000000"});
  EXPECT_EQ(r.plan.status, PlanStatus::complete);
}

/// Two threads and one give the same plan; another seed gives another.
TEST_P(EachPlanner, PlanDependsOnTheSeedAlone) {
  const auto text = [&](unsigned threads) {
    RunResult r = plan("stacked_box", kSmallBox, GetParam(), brief(GetParam(), "200000"), threads);
    EXPECT_EQ(r.plan.status, PlanStatus::complete);
    for (auto& step : r.plan.disassembly) step.seconds = 0;
    for (auto& part : r.plan.unsolved) part.seconds = 0;
    return to_json(r.plan);
  };
  EXPECT_EQ(text(1), text(3));
}

TEST_P(EachPlanner, WorksUnderEachSequencePlanner) {
  for (const std::string sequence : {"progressive", "queue", "random", "mcts", "ndbg", "state_based"}) {
    const std::string planner = GetParam();
    Settings set = brief(planner, planner == "bk_rrt" ? "6000" : planner == "rrt" ? "3000" : "800");
    set.push_back("sequence_planner.type=" + sequence);
    const RunResult r = plan("stacked_box", kSmallBox, GetParam(), set);
    EXPECT_EQ(r.plan.status, PlanStatus::complete) << sequence;
  }
}

/// A search ends when its budget is spent.
TEST_P(EachPlanner, GivesUpWhenItsBudgetIsSpent) {
  const RunResult r = plan("l_slot", {}, GetParam(), {"run.path_steps=20", "sequence_planner.type=queue"});
  EXPECT_EQ(r.plan.status, PlanStatus::partial);
  ASSERT_FALSE(r.plan.unsolved.empty());
  EXPECT_EQ(r.plan.unsolved[0].outcome, Outcome::timeout);
}

/// An enclosed part is not searched for by any planner, and the report has the proof.
TEST_P(EachPlanner, IsNotAskedAboutAClosedBox) {
  const RunResult r = plan("closed_box", {}, GetParam(), {"run.path_steps=300", "sequence_planner.type=queue"});
  EXPECT_EQ(r.plan.status, PlanStatus::partial);
  ASSERT_EQ(r.plan.unsolved.size(), 2u);
  for (const auto& u : r.plan.unsolved) {
    EXPECT_EQ(u.outcome, Outcome::infeasible);
    EXPECT_NE(u.message.find("enclosed by"), std::string::npos) << u.message;
    ASSERT_TRUE(u.certificate);
    EXPECT_EQ(r.plan.certificates.at(*u.certificate).kind, "enclosed_ball");
  }
}

/// An empty list: it races alone.
TEST_P(EachPlanner, SearchesAClosedBoxWhereNothingIsProved) {
  const RunResult r = plan("closed_box", {}, GetParam(),
                           {"run.path_steps=100", "sequence_planner.type=queue", "immobility.provers=[]"});
  ASSERT_EQ(r.plan.unsolved.size(), 2u);
  for (const auto& u : r.plan.unsolved) {
    EXPECT_NE(u.outcome, Outcome::infeasible);
    EXPECT_FALSE(u.certificate);
  }
  EXPECT_TRUE(r.plan.certificates.empty());
  EXPECT_EQ(r.proof_seconds, 0);
  EXPECT_FALSE(r.planner_counts.empty()) << "it searched";
}

INSTANTIATE_TEST_SUITE_P(Baselines, EachPlanner,
                         ::testing::Values("rrt", "t_rrt", "mv_t_rrt", "bk_rrt", "prm", "rrt_connect_removal"),
                         [](const auto& i) { return std::string(i.param); });

INSTANTIATE_TEST_SUITE_P(Baselines, EachButRoadmaps,
                         ::testing::Values("rrt", "t_rrt", "mv_t_rrt", "bk_rrt", "rrt_connect_removal"),
                         [](const auto& i) { return std::string(i.param); });

/// Found before anything runs, with the place in the file.
TEST(Baselines, DynamicsWithFclIsAConfigurationError) {
  for (const std::string planner : {"bfs", "bk_rrt"}) {
    try {
      session_of(planner, "fcl", {});
      ADD_FAILURE() << planner << " was accepted";
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find("needs a simulator with dynamics, which 'fcl' does not have"),
                std::string::npos)
          << e.what();
    }
  }
}

TEST(Baselines, GeometricPlannersTakeAnySimulatorWithDistance) {
  for (const std::string planner : {"rrt", "t_rrt", "mv_t_rrt"})
    for (const std::string simulator : {"fcl", "sdf_penalty"})
      EXPECT_NO_THROW(session_of(planner, simulator, {})) << planner << " on " << simulator;
}

/// A mating vector that no axis comes near to leads straight out.
TEST(Baselines, MatingVectorsFindAnInclinedShaft) {
  const RunResult r = plan("inclined_washer", {}, "mv_t_rrt", {"run.path_steps=20000", "path_planner.goal_bias=0.0"});
  ASSERT_EQ(r.plan.status, PlanStatus::complete);
  EXPECT_EQ(r.plan.disassembly[0].depth, 1u);
}

}  // namespace
}  // namespace dismantle
