#include "tool_access.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "dismantle/errors.h"
#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"
#include "scene.h"

namespace dismantle::checks {
namespace {

using namespace test;

// A screw in a well is for a long key; in a deeper well, for none: the wall is in the way. Whatever the pose and unit.
TEST(ToolAccess, AScrewInAWell) {
  Scene scene;
  const PartId screw_id = scene.add("screw", screw(), {0, 0, -10}), plate_id = scene.add("plate", plate());
  const PartId low = scene.add("low", wall(4, 40)), high = scene.add("high", wall(4, 330));
  everywhere(scene, [&](const Assembly& assembly, const Vector3d& down, const Pose& pose) {
    const std::string unit = assembly.unit;
    const ToolAccess check(ToolAccessParameters{.only = "hex_key_2.5, hex_key_long_2.5"});
    StepVerdict v = judge(check, assembly, {screw_id}, {plate_id}, down);
    EXPECT_EQ(v.cost, 0);
    nlohmann::json data = data_of(v, "tool");
    EXPECT_EQ(data["use"], "short arm in the screw");
    EXPECT_EQ(data["size"], "M3x10");
    EXPECT_NE(v.notes[0].text.find("M3x10, hex socket 2.5"), std::string::npos) << v.notes[0].text;
    const Vector3d from(data["from"][0], data["from"][1], data["from"][2]);
    EXPECT_LT((from + down).norm(), 1e-3);
    const Vector3d at(data["at"][0], data["at"][1], data["at"][2]);
    const double mm = unit == "m" ? 1000 : unit == "inch" ? 25.4 : 1;
    EXPECT_LT((mm * at - pose * Vector3d(0, 0, 3)).norm(), 0.02);
    const Vector3d handle(data["handle"][0], data["handle"][1], data["handle"][2]);
    EXPECT_NEAR(handle.dot(from), 0, 1e-9);
    // The solid of the tool, to be drawn: its shaft ends at the top of the screw, in every unit.
    const nlohmann::json& picture = data["picture"];
    EXPECT_NEAR(picture["mm"], mm, 1e-6 * mm);
    const Vector3d origin(picture["origin"][0], picture["origin"][1], picture["origin"][2]);
    EXPECT_LT(mm * (origin - at).norm(), 1e-6);
    EXPECT_EQ(picture["tool"][0]["tube"]["z"][0], 0);
    EXPECT_FALSE(picture["hand"].empty());

    v = judge(check, assembly, {screw_id}, {plate_id, low}, down);
    EXPECT_EQ(v.cost, 0);
    EXPECT_EQ(data_of(v, "tool")["use"], "long arm in the screw");

    v = judge(check, assembly, {screw_id}, {plate_id, high}, down);
    EXPECT_EQ(v.cost, 1);
    EXPECT_TRUE(v.allowed);
    EXPECT_NE(v.reason.find("'screw'"), std::string::npos);
    EXPECT_EQ(data_of(v, "blocked")["in_the_way"], nlohmann::json::array({"high"}));
    EXPECT_NE(v.notes[0].text.find("'high' is in the way"), std::string::npos) << v.notes[0].text;
    // What is not there yet is not in the way.
    EXPECT_EQ(judge(check, assembly, {screw_id}, {plate_id}, down).cost, 0);
  });
}

TEST(ToolAccess, ScaledCopiesHaveTheToolOfTheirTrueSize) {
  Scene scene;
  const PartId screw_id = scene.add("screw", screw(), {0, 0, -10}), plate_id = scene.add("plate", plate());
  for (Mesh& mesh : scene.meshes)
    for (Vector3d& p : mesh.vertices) p *= 2;
  const StepVerdict v = judge(ToolAccess(), scene.assembly(), {screw_id}, {plate_id}, -Vector3d::UnitZ());
  EXPECT_EQ(data_of(v, "tool")["tool"], "hex_key_5");
  EXPECT_EQ(data_of(v, "tool")["size"], "M6x20");
  // A thread bears over two diameters: 12 mm of pitch 1.
  EXPECT_EQ(data_of(v, "tool")["pitch"], 1);
  EXPECT_EQ(data_of(v, "tool")["turns"], 12);
  EXPECT_TRUE(std::any_of(v.notes.begin(), v.notes.end(), [](const StepNote& note) {
    return note.text.find(", 12 turns of 1 mm") != std::string::npos;
  }));
}

TEST(ToolAccess, SaysWhatWasNotChecked) {
  Scene scene;
  const PartId screw_id = scene.add("screw", screw(), {0, 0, -10}), plate_id = scene.add("plate", plate());
  Assembly assembly = scene.assembly();
  assembly.unit.clear();
  StepVerdict v = judge(ToolAccess(), assembly, {screw_id}, {plate_id}, -Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 0);
  EXPECT_EQ(data_of(v, "tool")["assumed"], "mm");
  for (const StepNote& note : v.notes) EXPECT_EQ(note.text.find("assumed"), std::string::npos) << note.text;
  // A hundred times as large: no table has it.
  for (Mesh& mesh : scene.meshes)
    for (Vector3d& p : mesh.vertices) p *= 100;
  v = judge(ToolAccess(), scene.assembly(), {screw_id}, {plate_id}, -Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 0);
  EXPECT_NE(std::string(data_of(v, "not_checked")["reason"]).find("size"), std::string::npos);
}

// A screw that only its name tells: a block, or a surface with a hole. It is in the plate, and comes with it.
TEST(ToolAccess, SaysThatAScrewWithoutAnAxisWasNotChecked) {
  Scene scene;
  const PartId block = scene.add("set screw M3x6", shapes::box({-1.4, -1.2, -7}, {1.4, 1.2, -1}));
  const PartId plate_id = scene.add("plate", plate()), far = scene.add("far", wall(4, 40));
  for (const bool open : {false, true}) {
    Assembly assembly = scene.assembly();
    assembly.parts[block].open = open;
    const StepVerdict v = judge(ToolAccess(), assembly, {block}, {plate_id}, -Vector3d::UnitZ());
    EXPECT_EQ(v.cost, 0);
    const std::string reason = data_of(v, "not_checked")["reason"];
    EXPECT_EQ(reason, open ? "its surface is not closed" : "it is known by its name only, and its shape has no axis");
    EXPECT_TRUE(judge(ToolAccess(), assembly, {block, plate_id}, {far}, -Vector3d::UnitZ()).notes.empty());
  }
}

TEST(ToolAccess, WithoutAToolThatFitsItCostsOne) {
  Scene scene;
  const PartId screw_id = scene.add("screw", screw(), {0, 0, -10}), plate_id = scene.add("plate", plate());
  const ToolAccess check(ToolAccessParameters{.only = "hex_key_3"});
  const StepVerdict v = judge(check, scene.assembly(), {screw_id}, {plate_id}, -Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 1);
  EXPECT_NE(v.notes.at(0).text.find("No tool of the catalogue fits 'screw'"), std::string::npos);
}

TEST(ToolAccess, AScrewThatMovesWithWhatItIsInWasDrivenBefore) {
  Scene scene;
  const PartId screw_id = scene.add("screw", screw(), {0, 0, -10}), plate_id = scene.add("plate", plate());
  const PartId high = scene.add("high", wall(4, 330));
  const StepVerdict v = judge(ToolAccess(), scene.assembly(), {screw_id, plate_id}, {high}, -Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 0);
  EXPECT_TRUE(v.notes.empty());
  // A washer that comes with it is no such part.
  const PartId washer = scene.add("washer", solids::ring(7, 3.2, 0.5), {0, 0, -0.5});
  EXPECT_EQ(judge(ToolAccess(), scene.assembly(), {screw_id, washer}, {plate_id, high}, -Vector3d::UnitZ()).cost, 1);
}

TEST(ToolAccess, ANutIsTightenedOnTheScrewThatIsThere) {
  Scene scene;
  const PartId nut = scene.add("nut", solids::nut(solids::polygon(6, 5.5), 3, 2.4), {0, 0, -9});
  const PartId screw_id = scene.add("screw", screw(), {0, 0, -10});
  const PartId box = scene.add("box", wall(4, 60), {0, 0, -60});
  const Assembly assembly = scene.assembly();
  // It comes from below, and so does the tool.
  StepVerdict v = judge(ToolAccess(), assembly, {nut}, {screw_id}, Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 0);
  const auto data = data_of(v, "tool");
  EXPECT_NEAR(double(data["from"][2]), -1, 1e-6);
  v = judge(ToolAccess(), assembly, {nut}, {screw_id, box}, Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 1);
  EXPECT_EQ(data_of(v, "blocked")["in_the_way"], nlohmann::json::array({"box"}));
  // Put in across its axis it is not screwed on.
  EXPECT_TRUE(judge(ToolAccess(), assembly, {nut}, {screw_id, box}, Vector3d::UnitX()).notes.empty());
  // Without the screw there is nothing to tighten.
  v = judge(ToolAccess(), assembly, {nut}, {box}, Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 1);
  EXPECT_EQ(data_of(v, "early")["nut"], "nut");
}

/// A flat ring with a gap, as a circlip is cut from sheet.
Mesh circlip(double inner, double outer, double thick) {
  Mesh mesh;
  constexpr std::uint32_t n = 48;
  for (std::uint32_t k = 0; k < n; ++k) {
    const double angle = 0.3 + (2 * std::numbers::pi - 0.6) * k / (n - 1);
    for (const double z : {0.0, thick})
      for (const double r : {inner, outer}) mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t k = 0; k + 1 < n; ++k) {
    const std::uint32_t a = 4 * k, b = a + 4;
    quad(a, b, b + 1, a + 1);
    quad(a + 1, b + 1, b + 3, a + 3);
    quad(a + 3, b + 3, b + 2, a + 2);
    quad(a + 2, b + 2, b, a);
  }
  const std::uint32_t last = 4 * (n - 1);
  quad(0, 1, 3, 2);
  quad(last, last + 2, last + 3, last + 1);
  return mesh;
}

TEST(ToolAccess, ACirclipWithoutRoomForPliers) {
  Scene scene;
  const PartId ring = scene.add("circlip 16", circlip(7.6, 11, 1));
  const PartId shaft = scene.add("shaft", shapes::tube(0, 7.5, -40, 5, 48));
  const PartId bore = scene.add("bore", shapes::tube(13, 40, -40, 60, 48));
  everywhere(scene, [&](const Assembly& assembly, const Vector3d& down) {
    StepVerdict v = judge(ToolAccess(), assembly, {ring}, {shaft}, down);
    EXPECT_EQ(v.cost, 0);
    EXPECT_NE(std::string(data_of(v, "tool")["tool"]).find("pliers"), std::string::npos);
    v = judge(ToolAccess(), assembly, {ring}, {shaft, bore}, down);
    EXPECT_EQ(v.cost, 1);
    EXPECT_EQ(data_of(v, "blocked")["in_the_way"], nlohmann::json::array({"bore"}));
  });
}

TEST(ToolAccess, AChangeOfTheToolCosts) {
  Scene scene;
  const PartId first = scene.add("first", screw(), {0, 0, -10});
  const PartId second = scene.add("second", screw(), {100, 0, -10});
  const PartId plate_id = scene.add("plate", plate());
  const PartId other = scene.add("nut", solids::nut(solids::polygon(6, 8), 5, 4), {50, 0, 0});
  const Assembly assembly = scene.assembly();
  const std::vector<PlacedPart> same{{first, Pose{}}}, nut{{other, Pose{}}};
  StepQuestion previous{assembly, same, {}};
  const Vector3d down = -Vector3d::UnitZ();
  EXPECT_EQ(judge(ToolAccess(), assembly, {second}, {plate_id, first}, down, &previous).cost, 0);
  StepQuestion with_nut{assembly, nut, {}};
  const StepVerdict v = judge(ToolAccess(), assembly, {second}, {plate_id, other}, down, &with_nut);
  EXPECT_NEAR(v.cost, 0.1, 1e-12);
  EXPECT_FALSE(v.reason.empty());
  // Of several equal fasteners, the first one counts.
  EXPECT_NEAR(judge(ToolAccess(), assembly, {first, second}, {plate_id}, down, &with_nut).cost, 0.1, 1e-12);
  EXPECT_EQ(judge(ToolAccess(), assembly, {first, second}, {plate_id}, down).cost, 0);
  // The tool that the step before needs is preferred.
  const ToolAccess two(ToolAccessParameters{.only = "hex_driver_2.5, hex_key_2.5"});
  EXPECT_EQ(judge(two, assembly, {second}, {plate_id, first}, down, &previous).cost, 0);
}

TEST(ToolAccess, UnknownToolsAndFilesAreErrors) {
  EXPECT_THROW(ToolAccess(ToolAccessParameters{.only = "hex_key_2.5, spanner"}), ConfigError);
  EXPECT_THROW(ToolAccess(ToolAccessParameters{.catalogue = "/no/such/tools.yaml"}), InputError);
}

}  // namespace
}  // namespace dismantle::checks
