// Forced steps that the user accepts: this pair, this depth, and nothing else.
#include "acceptance.h"

#include <gtest/gtest.h>

#include "dismantle/engine/run.h"
#include "dismantle/testing/fake_planning.h"

namespace dismantle {
namespace {

/// A block is pushed through a thick wall, and on through a second one if that stands in its way.
struct Push {
  explicit Push(bool second)
      : assembly(fake::assembly_of({{"block", {{{-4, -1, -1}, {-3, 1, 1}}}},
                                    {"wall", {{{-2, -2, -2}, {0, 2, 2}}}},
                                    {"second", {{{1, second ? -2.0 : 3.0, -2}, {1.5, second ? 2.0 : 5.0, 2}}}}})),
        done(assembly.parts.size()) {
    DisassemblyStep step;
    step.parts = {0};
    step.path = std::make_shared<const Path>(Path{{Pose{}}, {Pose{{9, 0, 0}, Pose{}.q}}});
    step.forced = ForcedCut{MotionDepth{0, 1, 0.5}, false, "no path", nullptr};
    done.add(std::move(step));
  }

  /// How the step is marked: empty if it is not accepted.
  std::string marked(PartId part, PartId against, double depth) {
    Constraints constraints;
    constraints.accept = {{part, against, "press", depth}};
    Plan plan = plan_of(done, assembly, RunOptions{});
    plan.status = PlanStatus::forced;
    RunContext context;
    mark_accepted(plan, done, assembly, constraints, Verifier(assembly, VerifyOptions{}), context);
    const std::string& word = plan.disassembly[0].forced->accepted;
    EXPECT_EQ(plan.status == PlanStatus::complete, !word.empty());
    EXPECT_EQ(plan.assembly_steps[0].forced->accepted, word) << "the step backwards is the same";
    return word;
  }

  Assembly assembly;
  Disassembly done;
};

TEST(Acceptance, ThePairInEitherOrderToItsDepth) {
  Push push(false);
  EXPECT_EQ(push.marked(0, 1, 0.5), "press");
  EXPECT_EQ(push.marked(1, 0, 0.6), "press");
  EXPECT_EQ(push.marked(0, 1, 0.49), "") << "it cuts deeper";
  EXPECT_EQ(push.marked(0, 2, 0.6), "") << "another partner";
}

TEST(Acceptance, NotWhenTheStepCutsIntoOthersToo) { EXPECT_EQ(Push(true).marked(0, 1, 0.5), ""); }

}  // namespace
}  // namespace dismantle
