// How far the parts of a forced step come: stated, checked again, and refused where it is too far.
#include "reached.h"

#include <gtest/gtest.h>

#include "dismantle/engine/run.h"
#include "dismantle/testing/fake_planning.h"
#include "dismantle/verification/check_plan.h"
#include "dismantle/verification/valid_stretch.h"

namespace dismantle {
namespace {

TEST(Reached, UpToTheWallAndNoFurther) {
  for (const double gap : {0.3, 1.0, 2.5}) {
    const Assembly assembly =
        fake::assembly_of({{"block", {{{-1, -1, -1}, {0, 1, 1}}}}, {"wall", {{{gap, -2, -2}, {gap + 2, 2, 2}}}}});
    const Verifier verifier(assembly, VerifyOptions{});
    RunContext context;
    Disassembly done(assembly.parts.size());
    DisassemblyStep step;
    step.parts = {0};
    step.path = std::make_shared<const Path>(divided_where_valid(assembly, verifier, step.parts, {{1, Pose{}}},
                                                                 {{Pose{}}, {Pose{{9, 0, 0}, Pose{}.q}}}, context));
    step.forced = ForcedCut{MotionDepth{0, 1, 1}, false, "no path", nullptr};
    done.add(std::move(step));
    Plan plan = plan_of(done, assembly, RunOptions{});
    set_reached(plan, done, verifier, context);
    PlanStep& written = plan.disassembly[0];
    ASSERT_EQ(written.transfer, 1U);
    std::vector<Pose>& poses = written.moves[0].poses;
    ASSERT_EQ(poses.size(), 3U);
    const double tolerance = 2.1 * verifier.options().max_penetration / assembly.normalization.scale;
    EXPECT_NEAR(poses[1].t.x(), gap / assembly.normalization.scale, tolerance);

    const auto refused = [&] {
      for (const PlanProblem& p : check_plan(plan, assembly, VerifyOptions{}, context).problems)
        if (p.message.find("valid up to pose 1") != std::string::npos) return true;
      return false;
    };
    EXPECT_FALSE(refused());
    poses[1].t.x() += 2 * tolerance;
    EXPECT_TRUE(refused());

    context.cancel.cancel();
    written.transfer = 0;
    set_reached(plan, done, verifier, context);
    EXPECT_EQ(written.transfer, 0U) << "not known";
  }
}

}  // namespace
}  // namespace dismantle
