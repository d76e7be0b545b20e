// The example of an oracle around an oracle, at work: what it refuses is in no plan, and everything else is.
#include <gtest/gtest.h>

#include "dismantle/engine/run.h"
#include "dismantle/host/registry.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/samples/samples.h"

namespace dismantle {
namespace {

RunResult plan(const std::string& planner, const ParamSet& parameters, const Eigen::Vector3d& up) {
  Registry registry;
  registry.scan();
  registry.load(PLUGIN_FILE);
  RunContext context;
  PrepareReport report;
  const Assembly assembly = prepare_assembly(samples::make("peg_in_hole", {}), "peg", "", {}, context, report);
  PlanningSetup setup;
  setup.simulator = registry.create<Simulator>("fcl");
  setup.path_planner = [&] { return registry.create<PathPlanner>("mv_t_rrt"); };
  setup.path_planner_id = "mv_t_rrt";
  setup.sequence_planner = registry.create<SequencePlanner>(planner, parameters);
  setup.objective.up = up;
  RunOptions options;
  options.path_steps = 2000;
  return run(assembly, setup, options, context);
}

double rise(const RunResult& result, const Eigen::Vector3d& up) {
  double least = 1e9;
  for (const DisassemblyStep& step : result.disassembly.steps())
    for (std::size_t i = 0; i < step.parts.size(); ++i)
      least = std::min(least, up.dot(step.path->back()[i].t - step.path->front()[i].t));
  return least;
}

/// Where the planner alone takes a part out downwards, the same planner behind the veto finds another way or says why
/// not.
TEST(Veto, NothingIsTakenOutDownwards) {
  bool refused = false;
  for (const double sign : {1.0, -1.0}) {
    const Eigen::Vector3d up = sign * Eigen::Vector3d::UnitZ();
    const RunResult alone = plan("progressive", {}, up), vetoed = plan("acme.veto", {}, up);
    ASSERT_EQ(alone.outcome, Outcome::solved);
    const double fell = rise(alone, up);
    if (vetoed.outcome == Outcome::solved) {
      EXPECT_GE(rise(vetoed, up), 0);
    } else {
      EXPECT_LT(fell, 0);
      ASSERT_FALSE(vetoed.plan.unsolved.empty());
      EXPECT_NE(vetoed.plan.unsolved.front().message.find("acme.veto"), std::string::npos);
    }
    refused = refused || fell < 0;
    EXPECT_EQ(plan("acme.veto", {{"drop", 1e6}}, up).outcome, Outcome::solved) << "a veto that refuses nothing";
  }
  EXPECT_TRUE(refused) << "a peg leaves along an axis, and some up is against it";
}

}  // namespace
}  // namespace dismantle
