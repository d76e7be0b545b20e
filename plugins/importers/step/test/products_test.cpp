// The product structure of STEP files: what belongs to one use of a product.
#include <gtest/gtest.h>

#include <BRepBuilderAPI_Transform.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>
#include <gp_Ax2.hxx>
#include <map>
#include <set>

#include "scratch.h"
#include "step_files.h"
#include "step_importer.h"

namespace dismantle::step_import {
namespace {

using namespace testing;

/// Three levels, a product that is used twice, once mirrored, and two bodies in one product.
TEST(StepProducts, EveryUseOfAProductHasItsOwnId) {
  const Scratch scratch;
  StepFile file;
  BRep_Builder builder;
  TopoDS_Compound two;
  builder.MakeCompound(two);
  builder.Add(two, box(1, 2, 3));
  builder.Add(two, BRepBuilderAPI_Transform(box(1, 1, 1), moved(5, 0, 0)).Shape());
  const TDF_Label servo = file.product(two, "servo"), frame = file.product(box(9, 9, 9), "frame");
  const TDF_Label arm = file.assembly("arm"), machine = file.assembly("machine");
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)));
  file.place(arm, servo, moved(0, 20, 0), "left");
  file.place(arm, servo, moved(0, -20, 0), "right");
  file.place(machine, arm, moved(0, 0, 50), "arm_1");
  file.place(machine, arm, moved(0, 0, 90), "arm_2");
  file.place(machine, frame, moved(0, 0, 0));
  file.place(machine, file.product(BRepBuilderAPI_Transform(two, mirror).Shape(), "servo_mirrored"), moved(-40, 0, 0));
  file.write(scratch / "machine.step");
  std::map<std::string, std::size_t> bodies, uses;  // of a use; of a product
  for (const RawPart& part : StepImporter({}, STEP_READER).read(scratch / "machine.step", RunContext())) {
    EXPECT_EQ(part.instances.size(), part.parents.size() + 1) << part.name;
    if (bodies[part.instances.back()]++ == 0) ++uses[part.product];
    std::set<std::string> ids(part.instances.begin(), part.instances.end());
    EXPECT_EQ(ids.size(), part.instances.size());
  }
  EXPECT_EQ(uses, (std::map<std::string, std::size_t>{{"frame", 1}, {"servo", 4}, {"servo_mirrored", 1}}));
  std::vector<std::size_t> sizes;
  for (const auto& [id, count] : bodies) sizes.push_back(count);
  std::ranges::sort(sizes);
  EXPECT_EQ(sizes, (std::vector<std::size_t>{1, 2, 2, 2, 2, 2}));
}

}  // namespace
}  // namespace dismantle::step_import
