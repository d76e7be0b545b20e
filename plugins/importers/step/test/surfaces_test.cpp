// Open shells and faces of STEP files are parts with an open surface.
#include <gtest/gtest.h>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <fstream>
#include <iterator>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/run_context.h"
#include "read_step.h"
#include "scratch.h"
#include "step_files.h"
#include "step_importer.h"

namespace dismantle::step_import {
namespace {

using namespace testing;

/// Puts the first `count` faces of a box of edge length 5 into `empty`.
TopoDS_Shape faces_of_a_box(int count, TopoDS_Shape empty) {
  BRep_Builder builder;
  for (TopExp_Explorer it(box(5, 5, 5), TopAbs_FACE); it.More() && count-- > 0; it.Next())
    builder.Add(empty, it.Current());
  return empty;
}

TEST(StepSurfaces, ArePartsAndCurvesAreNamed) {
  StepFile out;
  const TDF_Label root = out.assembly("root");
  BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  TopoDS_Compound loose, single;
  builder.MakeCompound(loose);
  builder.MakeCompound(single);
  out.place(root, out.product(box(9, 9, 9), "block"), moved(0, 0, 0));
  out.place(root, out.product(faces_of_a_box(5, shell), "hood"), moved(20, 0, 0));
  out.place(root, out.product(faces_of_a_box(2, loose), "faces"), moved(40, 0, 0));
  out.place(root, out.product(faces_of_a_box(1, single), "face"), moved(0, 20, 0));
  out.place(root, out.product(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 2, 3)).Shape(), "axis"),
            moved(0, 0, 0));
  Scratch scratch;
  out.write(scratch / "a.step");
  const Read in = read(scratch / "a.step");
  ASSERT_EQ(names(in), (std::vector<std::string>{"block", "hood", "faces", "face", "axis"})) << in.log;
  const double areas[] = {6 * 81, 5 * 25, 2 * 25, 25};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(in.parts[i].problem, "");
    EXPECT_NEAR(surface_area(in.parts[i].mesh), areas[i], 1e-9) << in.parts[i].name;
  }
  EXPECT_NE(in.parts[4].problem.find("it holds 1 curve"), std::string::npos) << in.parts[4].problem;
  EXPECT_TRUE(in.parts[4].by_meaning) << "construction geometry";

  RunContext context;
  PrepareReport report;
  const Assembly assembly = prepare_assembly(in.parts, "made up", "0", {}, context, report);
  ASSERT_EQ(assembly.parts.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(assembly.parts[i].open, i > 0) << assembly.parts[i].name;
}

TEST(StepSurfaces, FacesWithoutAShellAreOne) {
  StepFile out;
  TopoDS_Shell shell;
  BRep_Builder().MakeShell(shell);
  const TDF_Label root = out.assembly("root");
  out.place(root, out.product(box(1, 1, 1), "cube"), moved(9, 0, 0));
  out.place(root, out.product(faces_of_a_box(3, shell), "hood"), moved(0, 0, 0));
  const Scratch scratch;
  std::string text = replaced(text_of(out, scratch), "OPEN_SHELL", "CONNECTED_FACE_SET");
  text = replaced(text, "SHELL_BASED_SURFACE_MODEL", "FACE_BASED_SURFACE_MODEL");
  ASSERT_NE(text.find("CONNECTED_FACE_SET"), std::string::npos);
  const Read in = read(scratch.write("a.step", text));
  ASSERT_EQ(names(in), (std::vector<std::string>{"cube", "hood"})) << in.log;
  EXPECT_EQ(in.parts[1].problem, "");
  EXPECT_NEAR(surface_area(in.parts[1].mesh), 75, 1e-9);
}

}  // namespace
}  // namespace dismantle::step_import
