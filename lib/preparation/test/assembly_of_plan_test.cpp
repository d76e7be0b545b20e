// The assembly that a plan is verified on.
#include "dismantle/preparation/assembly_of_plan.h"

#include <gtest/gtest.h>

#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

// Law: every part is what the plan says that it is, whatever the order of the input; where the plan says nothing, nothing is known.
TEST(AssemblyOfPlan, PartsHaveTheKindsOfThePlan) {
  Plan plan;
  plan.assembly.sha256 = "abc";
  plan.assembly.scale = 1;
  InputParts input;
  input.sha256 = "abc";
  for (unsigned id = 0; id < 3; ++id) {
    PlanPart part;
    part.id = id;
    part.name = part.file = "part" + std::to_string(id);
    if (id != 1) part.kind = PartKind{id == 0 ? "screw" : "nut", "M3", 0.9, "by its shape"};
    plan.assembly.parts.push_back(part);
    RawPart raw;
    raw.name = raw.file = part.name;
    raw.mesh = shapes::box({2.0 * id, 0, 0}, {2.0 * id + 1, 1, 1});
    input.parts.push_back(raw);
  }
  RunContext context;
  const Assembly assembly = assembly_of_plan(plan, input, "input", context);
  ASSERT_EQ(assembly.parts.size(), 3u);
  for (std::size_t id = 0; id < 3; ++id) EXPECT_EQ(assembly.parts[id].kind, plan.assembly.parts[id].kind);
}

}  // namespace
}  // namespace dismantle
