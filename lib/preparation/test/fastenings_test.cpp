// `dismantle check` says what screws hold, and notes what is wrong with them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "dismantle/fasteners/recognise.h"
#include "dismantle/preparation/check_assembly.h"
#include "dismantle/testing/shapes.h"
#include "fasteners/test/solids.h"

namespace dismantle {
namespace {

namespace solids = fasteners::test;

/// Two bolts M3x12 through two plates; `nuts` of them have nuts.
AssemblyCheck checked(int nuts, bool kinds = true) {
  std::vector<Mesh> meshes;
  std::vector<std::string> names;
  const auto add = [&](const std::string& name, const Mesh& mesh, double x, double z) {
    meshes.push_back(shapes::moved(mesh, shapes::shift({x, 0, z})));
    names.push_back(name);
  };
  const auto plate = [](double low, double high) {
    const Mesh half = shapes::tube(1.7, 10, low, high, 64);
    return shapes::joined(half, shapes::moved(half, shapes::shift({25, 0, 0})));
  };
  add("upper", plate(-4, 0), 0, 0);
  add("lower", plate(-8, -4), 0, 0);
  for (int i = 0; i < 2; ++i)
    add("bolt#" + std::to_string(i + 1), solids::screw({3, 12, 5.5, 3, {}, solids::polygon(6, 2.5), 1.5}), 25.0 * i,
        -12);
  for (int i = 0; i < nuts; ++i)
    add("nut#" + std::to_string(i + 1), solids::nut(solids::polygon(6, 5.5), 2.5, 2.4), 25.0 * i, -10.4);
  Assembly assembly = shapes::assembly_of(meshes);
  for (std::size_t i = 0; i < names.size(); ++i) {
    assembly.parts[i].name = names[i];
    assembly.parts[i].surface = assembly.parts[i].mesh;
  }
  assembly.unit = "mm";
  if (kinds) fasteners::recognise_kinds(assembly, RunContext{});
  PrepareReport report;
  return check_assembly(assembly, report, 1e-3, RunContext{});
}

std::vector<Finding> faults(const AssemblyCheck& check) {
  std::vector<Finding> out;
  for (const Finding& f : check.findings)
    if (f.kind == FindingKind::fastener) out.push_back(f);
  return out;
}

TEST(CheckedFastenings, SaysWhatScrewsHold) {
  const AssemblyCheck check = checked(2);
  ASSERT_EQ(check.fastenings.size(), 2u);
  EXPECT_EQ(check.fastenings[0].screws, std::vector<std::string>{"bolt#1"});
  EXPECT_EQ(check.fastenings[0].clamps, (std::vector<std::string>{"upper", "lower"}));
  EXPECT_EQ(check.fastenings[0].into, std::vector<std::string>{"nut#1"});
  EXPECT_TRUE(faults(check).empty());
  const std::string text = findings_text(check, "x");
  EXPECT_NE(text.find("1x M3x12: clamps 'upper' and 'lower' together; driven into 'nut#2'"), std::string::npos) << text;
  const nlohmann::json json = nlohmann::json::parse(findings_json(check));
  EXPECT_EQ(json["fasteners"][1]["screws"], nlohmann::json::array({"bolt#2"}));
  EXPECT_EQ(json["fasteners"][1]["text"], "clamps 'upper' and 'lower' together; driven into 'nut#2'");
}

TEST(CheckedFastenings, MissingNutsAreOneNoteAndNoError) {
  const AssemblyCheck one = checked(1), none = checked(0);
  ASSERT_EQ(faults(one).size(), 1u);
  EXPECT_EQ(faults(one)[0].severity, Severity::note);
  EXPECT_EQ(faults(one)[0].parts, std::vector<std::string>{"bolt#2"});
  EXPECT_TRUE(faults(one)[0].details.empty());
  ASSERT_EQ(faults(none).size(), 1u);
  EXPECT_EQ(faults(none)[0].details.size(), 2u);
  EXPECT_NE(faults(none)[0].message.find("the same of 1 more"), std::string::npos) << faults(none)[0].message;
  EXPECT_EQ(none.count(Severity::error), 0u);
}

TEST(CheckedFastenings, WithoutKindsNothingIsSaid) {
  const AssemblyCheck check = checked(0, false);
  EXPECT_TRUE(check.fastenings.empty());
  EXPECT_TRUE(faults(check).empty());
}

}  // namespace
}  // namespace dismantle
