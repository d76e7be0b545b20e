// Tests of acme.lines beyond the laws of its kind, which `dismantle plugins check` tests.
#include <gtest/gtest.h>

#include "dismantle/engine/run.h"
#include "dismantle/host/registry.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/fake_planning.h"

namespace {

/// Plans the path of one part, with all others fixed.
dismantle::Outcome plan(const dismantle::Assembly& assembly, const std::string& part) {
  dismantle::Registry registry;
  registry.scan();
  registry.load(PLUGIN_FILE);
  dismantle::PlanningSetup setup;
  setup.simulator = registry.create<dismantle::Simulator>("fcl");
  setup.path_planner = [&registry] { return registry.create<dismantle::PathPlanner>("acme.lines"); };
  setup.path_planner_id = "acme.lines";
  dismantle::RunOptions options;
  options.only_part = part;
  dismantle::RunContext context;
  return dismantle::run(assembly, setup, options, context).outcome;
}

dismantle::Assembly sample(const std::string& name, double clearance) {
  dismantle::RunContext context;
  dismantle::PrepareReport report;
  return dismantle::prepare_assembly(dismantle::samples::make(name, {{"clearance", clearance}}), name, "", {}, context,
                                     report);
}

TEST(AcmeLines, TakesAPegOutOfItsHoleAtAnyClearance) {
  dismantle::Rng rng(1);
  for (int trial = 0; trial < 5; ++trial) {
    const double clearance = rng.uniform(0.05, 0.5);  // mm
    EXPECT_EQ(plan(sample("peg_in_hole", clearance), "peg"), dismantle::Outcome::solved) << clearance;
  }
}

TEST(AcmeLines, FindsNothingWhereThePathHasACorner) {
  EXPECT_EQ(plan(sample("l_slot", 0.3), "slider"), dismantle::Outcome::exhausted);
}

TEST(AcmeLines, NeverLeavesAClosedBox) {
  EXPECT_EQ(plan(dismantle::fake::closed_box(), "plate"), dismantle::Outcome::exhausted);
}

}  // namespace
