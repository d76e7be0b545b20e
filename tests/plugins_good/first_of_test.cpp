// The example of a planner that holds others, at work: its members are asked in their order, within their limits.
#include <gtest/gtest.h>

#include "dismantle/engine/run.h"
#include "dismantle/host/registry.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/samples/samples.h"

namespace dismantle {
namespace {

RunResult plan(const std::string& sample, const ParamSet& parameters, const std::string& part,
               const std::vector<PluginChoice>& members, const std::string& last, std::uint64_t steps) {
  Registry registry;
  registry.scan();
  registry.load(PLUGIN_FILE);
  RunContext context;
  PrepareReport report;
  const Assembly assembly = prepare_assembly(samples::make(sample, parameters), sample, "", {}, context, report);
  PlanningSetup setup;
  setup.simulator = registry.create<Simulator>("fcl");
  setup.path_planner = [&] {
    return registry.create<PathPlanner>("acme.first_of", {{"of", members}, {"last", PluginChoice{last, {}, {}}}});
  };
  setup.path_planner_id = "acme.first_of";
  RunOptions options;
  options.only_part = part;
  options.path_timeout = 0;
  options.path_steps = steps;
  return run(assembly, setup, options, context);
}

PluginChoice member(const std::string& type, std::int64_t steps) { return {type, {}, {{"steps", steps}}}; }

/// What the first one does not find within its steps, the next one does.
TEST(FirstOf, TheNextOneIsAskedWhereOneFails) {
  Rng rng(1);
  for (int trial = 0; trial < 5; ++trial) {
    const ParamSet peg{{"clearance", rng.uniform(0.1, 0.5)}, {"length", rng.uniform(8, 20)}};
    EXPECT_NE(plan("peg_in_hole", peg, "peg", {member("mv_t_rrt", 5)}, "mv_t_rrt", 5).outcome, Outcome::solved);
    const RunResult r = plan("peg_in_hole", peg, "peg", {member("mv_t_rrt", 5)}, "mv_t_rrt", 50'000);
    EXPECT_EQ(r.outcome, Outcome::solved);
    EXPECT_GT(r.planner_counts.at("state_checks"), 5);
  }
}

/// Their limits add up to no more than that of the query.
TEST(FirstOf, KeepsToTheBudgetOfTheQuery) {
  for (const std::uint64_t steps : {100, 1000, 5000}) {
    const RunResult r = plan("closed_box", {}, "plate", {member("rrt", 60), member("t_rrt", 0)}, "mv_t_rrt", steps);
    EXPECT_NE(r.outcome, Outcome::solved);
    ASSERT_TRUE(r.planner_counts.contains("state_checks"));
    EXPECT_LE(r.planner_counts.at("state_checks"), static_cast<double>(steps + 64));
  }
}

}  // namespace
}  // namespace dismantle
