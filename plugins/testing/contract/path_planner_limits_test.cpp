// Laws of all path planners: budgets, deadlines, cancellation, refused paths, missing simulator capabilities.
#include "path_planner_contract.h"

namespace dismantle::contract {
namespace {

TEST_P(PathPlannerContract, NothingIsSolvedWhenEveryPathIsRefused) {
  for (const bool witness : {false, true})
    for (std::size_t which = 0; which < 2; ++which) {
      const Small& small = small_assemblies()[which];
      Run run;
      plan(run, which, {.max_steps = 5'000}, {}, [&](const Path&) {
        fake::Ruling v;
        v.has_witness = witness;
        v.part = small.leaves;
        v.other = small.leaves == 0 ? 1 : 0;
        v.point = small.assembly.parts[small.leaves].mesh->vertices.front();
        v.reason = "refused";
        return v;
      });
      EXPECT_FALSE(is_success(run.result.outcome()));
    }
}

TEST_P(PathPlannerContract, ARefusedPathIsNotShownForEver) {
  Run run;
  int refusals = 0;
  plan(run, 0, {.max_steps = kPlenty}, {}, [&](const Path& path) {
    if (refusals++ > 0) return verify(small_assemblies()[0], small_assemblies()[0].scene(), path);
    return fake::Ruling{};
  });
  EXPECT_LT(run.checked.size(), 200u);
}

TEST_P(PathPlannerContract, CancelledBeforeTheStart) {
  for (std::size_t which = 0; which < small_assemblies().size(); ++which) {
    RunContext context;
    context.cancel.cancel();
    Run run;
    plan(run, which, {}, context);
    EXPECT_EQ(run.result.outcome(), Outcome::cancelled);
    EXPECT_LE(run.counted.steps, kLook);
    EXPECT_TRUE(run.checked.empty());
  }
}

TEST_P(PathPlannerContract, CancelledOnTheWay) {
  RunContext context;
  const CancelToken cancel = context.cancel;
  Run run;
  run.counted.on_step = [&] {
    if (run.counted.steps >= 20) cancel.cancel();
  };
  plan(run, 1, {}, context);
  if (run.result.outcome() != Outcome::solved && cancel.cancelled()) {  // a search may end before it has used 20 steps
    EXPECT_EQ(run.result.outcome(), Outcome::cancelled);
  }
  EXPECT_LE(run.counted.steps, 20 + 2 * kLook);
}

TEST_P(PathPlannerContract, ADeadlineThatHasPassedIsATimeout) {
  RunContext context;
  context.deadline = Deadline::after_seconds(0);
  Run run;
  plan(run, 0, {}, context);
  EXPECT_EQ(run.result.outcome(), Outcome::timeout);
  EXPECT_LE(run.counted.steps, kLook);
}

TEST_P(PathPlannerContract, StepBudgetsAreKept) {
  Run free;
  plan(free, 1);
  for (const std::uint64_t budget : {1u, 30u, 300u}) {
    Run run;
    plan(run, 1, {.max_steps = budget});  // expect_lawful checks the steps
    if (free.counted.steps > budget + kLook) {
      EXPECT_EQ(run.result.outcome(), Outcome::timeout) << budget;
    }
  }
}

TEST_P(PathPlannerContract, UnsupportedWhereTheSimulatorLacksSomething) {
  const Capabilities needs = make()->traits().needs;
  std::vector<Capabilities> lacking;
  const Capabilities full = ready()->simulator->capabilities();
  if (needs.dynamics) lacking.push_back({false, full.contacts, full.distance, full.max_moving});
  if (needs.contacts) lacking.push_back({full.dynamics, false, full.distance, full.max_moving});
  if (needs.distance) lacking.push_back({full.dynamics, full.contacts, false, full.max_moving});
  const Small& small = small_assemblies()[0];
  for (const Capabilities& has : lacking) {
    Counted counted;
    CountingSimulator simulator(ready()->simulator, counted);
    simulator.has = has;
    RunContext context;
    const fake::RuleChecker checker = fake::accept_all();
    const PathQuery query{small.assembly, simulator, *ready()->prepared[0], small.scene(), {}, kTolerance, checker};
    const auto planner = make();
    const PathResult r = plan_path(*planner, query, context);
    EXPECT_EQ(r.outcome(), Outcome::unsupported);
    EXPECT_FALSE(r.message.empty()) << "says what is missing";
    EXPECT_EQ(counted.steps, 0u);
  }
}

}  // namespace
}  // namespace dismantle::contract
