#include "tool_access.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "dismantle/errors.h"
#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"
#include "solids.h"

namespace dismantle::checks {
namespace {

namespace solids = fasteners::test;
using Eigen::Vector3d;

/// Parts in millimetres, then all of them at a pose, in a unit, at the scale of an assembly.
struct Scene {
  std::vector<Mesh> meshes;
  std::vector<std::string> names;
  PartId add(const std::string& name, Mesh mesh, const Vector3d& at = Vector3d::Zero()) {
    for (Vector3d& p : mesh.vertices) p += at;
    meshes.push_back(std::move(mesh));
    names.push_back(name);
    return static_cast<PartId>(meshes.size() - 1);
  }
  Assembly assembly(const Pose& pose = {}, double scale = 0.1, const std::string& unit = "mm") const {
    const double mm = unit == "m" ? 1000 : unit == "inch" ? 25.4 : 1;
    std::vector<Mesh> placed = meshes;
    for (Mesh& mesh : placed)
      for (Vector3d& p : mesh.vertices) p = scale * (pose * p) / mm;
    Assembly out = shapes::assembly_of(placed);
    for (std::size_t i = 0; i < names.size(); ++i) out.parts[i].name = names[i];
    out.unit = unit;
    out.normalization.scale = scale;
    return out;
  }
};

/// M3x10 with a hexagon socket of 2.5; the seat of its head is z = 0.
Mesh screw() { return solids::screw({3, 10, 5.5, 3, {}, solids::polygon(6, 2.5), 1.5}); }
/// A plate with a threaded hole, under the head.
Mesh plate() {
  return solids::turned_solid(
      {{-12, solids::polygon(4, 60)}, {0, solids::polygon(4, 60)}, {0, solids::circle(3)}, {-12, solids::circle(3)}},
      144);
}
/// A wall around a well of this radius above the plate.
Mesh wall(double radius, double high) {
  return solids::turned_solid({{0.01, solids::circle(60)},
                               {high, solids::circle(60)},
                               {high, solids::circle(2 * radius)},
                               {0.01, solids::circle(2 * radius)}},
                              96);
}

StepVerdict judge(const ToolAccess& check, const Assembly& assembly, const std::vector<PartId>& moving,
                  const std::vector<PartId>& present, const Vector3d& direction,
                  const StepQuestion* previous = nullptr) {
  std::vector<PlacedPart> in, there;
  for (const PartId p : moving) in.push_back({p, Pose{}});
  for (const PartId p : present) there.push_back({p, Pose{}});
  StepQuestion question{assembly, in, there, direction};
  question.previous = previous;
  return check.judge(question, RunContext{});
}

nlohmann::json data_of(const StepVerdict& v, const std::string& kind) {
  EXPECT_EQ(v.notes.size(), 1u);
  if (v.notes.size() != 1) return nlohmann::json::object();
  EXPECT_EQ(v.notes[0].kind, "tool_access." + kind) << v.notes[0].text;
  return nlohmann::json::parse(v.notes[0].data);
}

// A screw in a well is for a long key; in a deeper well, for none: the wall is in the way. Whatever the pose and unit.
TEST(ToolAccess, AScrewInAWell) {
  Rng rng(3);
  Scene scene;
  const PartId screw_id = scene.add("screw", screw(), {0, 0, -10}), plate_id = scene.add("plate", plate());
  const PartId low = scene.add("low", wall(4, 40)), high = scene.add("high", wall(4, 330));
  for (const char* unit : {"mm", "m", "inch"}) {
    const Pose pose = shapes::random_pose(rng, 30);
    const Assembly assembly = scene.assembly(pose, rng.uniform(0.01, 2), unit);
    const Vector3d down = pose.q * -Vector3d::UnitZ();
    const ToolAccess check(ToolAccessParams{.only = "hex_key_2.5, hex_key_long_2.5"});
    StepVerdict v = judge(check, assembly, {screw_id}, {plate_id}, down);
    EXPECT_EQ(v.cost, 0);
    nlohmann::json data = data_of(v, "tool");
    EXPECT_EQ(data["use"], "short arm in the screw");
    EXPECT_EQ(data["size"], "M3x10");
    EXPECT_NE(v.notes[0].text.find("M3x10, hex socket 2.5"), std::string::npos) << v.notes[0].text;
    const Vector3d from(data["from"][0], data["from"][1], data["from"][2]);
    EXPECT_LT((from + down).norm(), 1e-3);
    const Vector3d at(data["at"][0], data["at"][1], data["at"][2]);
    const double mm = std::string(unit) == "m" ? 1000 : std::string(unit) == "inch" ? 25.4 : 1;
    EXPECT_LT((mm * at - pose * Vector3d(0, 0, 3)).norm(), 0.02);
    const Vector3d handle(data["handle"][0], data["handle"][1], data["handle"][2]);
    EXPECT_NEAR(handle.dot(from), 0, 1e-9);

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
  }
}

TEST(ToolAccess, ScaledCopiesHaveTheToolOfTheirTrueSize) {
  Scene scene;
  const PartId screw_id = scene.add("screw", screw(), {0, 0, -10}), plate_id = scene.add("plate", plate());
  for (Mesh& mesh : scene.meshes)
    for (Vector3d& p : mesh.vertices) p *= 2;
  const StepVerdict v = judge(ToolAccess(), scene.assembly(), {screw_id}, {plate_id}, -Vector3d::UnitZ());
  EXPECT_EQ(data_of(v, "tool")["tool"], "hex_key_5");
  EXPECT_EQ(data_of(v, "tool")["size"], "M6x20");
}

TEST(ToolAccess, SaysWhatWasNotChecked) {
  Scene scene;
  const PartId screw_id = scene.add("screw", screw(), {0, 0, -10}), plate_id = scene.add("plate", plate());
  Assembly assembly = scene.assembly();
  assembly.unit.clear();
  StepVerdict v = judge(ToolAccess(), assembly, {screw_id}, {plate_id}, -Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 0);
  EXPECT_EQ(data_of(v, "tool")["assumed"], "mm");
  // A hundred times as large: no table has it.
  for (Mesh& mesh : scene.meshes)
    for (Vector3d& p : mesh.vertices) p *= 100;
  v = judge(ToolAccess(), scene.assembly(), {screw_id}, {plate_id}, -Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 0);
  EXPECT_NE(std::string(data_of(v, "not_checked")["reason"]).find("size"), std::string::npos);
}

TEST(ToolAccess, WithoutAToolThatFitsItCostsOne) {
  Scene scene;
  const PartId screw_id = scene.add("screw", screw(), {0, 0, -10}), plate_id = scene.add("plate", plate());
  const ToolAccess check(ToolAccessParams{.only = "hex_key_3"});
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
  EXPECT_EQ(v.cost, 0);
  EXPECT_TRUE(v.notes.empty());
}

/// A bolt M3x12 from above and a nut through two plates of 4 mm.
struct Bolted : Scene {
  PartId bolt, upper, lower, nut;
  Bolted() {
    bolt = add("bolt", solids::screw({3, 12, 5.5, 3, {}, solids::polygon(6, 2.5), 1.5}), {0, 0, -12});
    upper = add("upper", shapes::tube(1.7, 15, -4, 0, 64));
    lower = add("lower", shapes::tube(1.7, 15, -8, -4, 64));
    nut = add("nut", solids::nut(solids::polygon(6, 5.5), 2.5, 2.4), {0, 0, -10.4});
  }
};

// A nut turns with its bolt unless a second tool holds it: both have room, on either end, whatever the pose and unit.
TEST(ToolAccess, ABoltIsHeldWhileItsNutIsTightened) {
  Rng rng(8);
  for (const char* unit : {"mm", "m", "inch"}) {
    const Bolted s;
    const Pose pose = shapes::random_pose(rng, 30);
    const Assembly assembly = s.assembly(pose, rng.uniform(0.01, 2), unit);
    const Vector3d up = pose.q * Vector3d::UnitZ();
    const StepVerdict v = judge(ToolAccess(), assembly, {s.nut}, {s.bolt, s.upper, s.lower}, up);
    EXPECT_EQ(v.cost, 0);
    const nlohmann::json data = data_of(v, "tool");
    EXPECT_EQ(data["part"], "nut");
    ASSERT_TRUE(data.contains("hold")) << v.notes[0].text;
    EXPECT_EQ(data["hold"]["part"], "bolt");
    EXPECT_EQ(data["hold"]["tool"], "hex_key_2.5");
    const Vector3d from(data["from"][0], data["from"][1], data["from"][2]);
    const Vector3d other(data["hold"]["from"][0], data["hold"]["from"][1], data["hold"]["from"][2]);
    EXPECT_LT((from + up).norm(), 1e-3);
    EXPECT_LT((other - up).norm(), 1e-3);
    EXPECT_NE(v.notes[0].text.find("hold 'bolt' (M3x12, hex socket 2.5) with hex key 2.5"), std::string::npos)
        << v.notes[0].text;
    EXPECT_NE(v.notes[0].text.find("'bolt' clamps 'upper' and 'lower' together"), std::string::npos);
    EXPECT_EQ(data["fastens"]["clamps"], nlohmann::json::array({"upper", "lower"}));
    EXPECT_EQ(data["fastens"]["into"], nlohmann::json::array({"nut"}));
  }
}

TEST(ToolAccess, WithoutRoomForTheSecondToolItCosts) {
  Bolted s;
  const PartId lid = s.add("lid", wall(4, 330));
  const Assembly assembly = s.assembly();
  StepVerdict v = judge(ToolAccess(), assembly, {s.nut}, {s.bolt, s.upper, s.lower, lid}, Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 1);
  nlohmann::json data = data_of(v, "blocked");
  EXPECT_EQ(data["in_the_way"], nlohmann::json::array({"lid"}));
  EXPECT_NE(v.notes[0].text.find("No tool of the catalogue holds 'bolt'"), std::string::npos) << v.notes[0].text;
  // Both tools count as changes.
  const std::vector<PlacedPart> plate_only{{s.lower, Pose{}}};
  const StepQuestion previous{assembly, plate_only, {}};
  v = judge(ToolAccess(), assembly, {s.nut}, {s.bolt, s.upper, s.lower}, Vector3d::UnitZ(), &previous);
  EXPECT_NEAR(v.cost, 0.2, 1e-12);
}

TEST(ToolAccess, ABoltWaitsForItsNut) {
  const Bolted s;
  const Assembly assembly = s.assembly();
  const StepVerdict v = judge(ToolAccess(), assembly, {s.bolt}, {s.upper, s.lower}, -Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 0);
  EXPECT_EQ(data_of(v, "later")["nut"], "nut");
  EXPECT_EQ(v.notes[0].text.find("Put in 'bolt' by hand: 'nut' is screwed on later."), 0u) << v.notes[0].text;
}

// In a pocket with corners the nut needs no second tool, whichever of the two comes last.
TEST(ToolAccess, ANutInAPocketIsNotHeld) {
  Bolted s;
  const PartId pocket = s.add("pocket", solids::turned_solid({{-30, solids::circle(24)},
                                                              {-8, solids::circle(24)},
                                                              {-8, solids::polygon(6, 5.8)},
                                                              {-30, solids::polygon(6, 5.8)}}));
  const Assembly assembly = s.assembly();
  const StepVerdict v = judge(ToolAccess(), assembly, {s.bolt}, {s.upper, s.lower, s.nut, pocket}, -Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 0);
  EXPECT_EQ(data_of(v, "tool")["kept_by"], "pocket");
  const StepVerdict last =
      judge(ToolAccess(), assembly, {s.nut}, {s.upper, s.lower, s.bolt, pocket}, Vector3d::UnitZ());
  EXPECT_EQ(last.cost, 0);
  const nlohmann::json data = data_of(last, "tool");
  EXPECT_EQ(data["turned"], "bolt");
  EXPECT_EQ(data["kept_by"], "pocket");
}

// A screw that is tightened before what it clamps is there costs; one note, with the names.
TEST(ToolAccess, AScrewComesAfterWhatItClamps) {
  Scene s;
  const PartId screw_id = s.add("screw", screw(), {0, 0, -10});
  const PartId lid = s.add("lid", shapes::tube(1.7, 15, -3, 0, 64));
  const PartId base = s.add("base", shapes::tube(1.25, 15, -20, -3, 64));
  const Assembly assembly = s.assembly();
  EXPECT_EQ(judge(ToolAccess(), assembly, {screw_id}, {lid, base}, -Vector3d::UnitZ()).cost, 0);
  const StepVerdict v = judge(ToolAccess(), assembly, {screw_id}, {base}, -Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 1);
  EXPECT_TRUE(v.allowed);
  EXPECT_EQ(v.reason, "'screw' is tightened before what it clamps is there");
  ASSERT_EQ(v.notes.size(), 2u);
  EXPECT_EQ(v.notes[1].kind, "tool_access.early");
  EXPECT_EQ(v.notes[1].text, "'screw' is tightened too early: it clamps 'lid', which is not there yet.");
}

// The first of four equal screws says how they are tightened, the others do not.
TEST(ToolAccess, APatternIsTightenedCrosswise) {
  Scene s;
  Mesh lid, base;
  std::vector<PartId> screws;
  for (const Vector3d& at : {Vector3d(0, 0, 0), Vector3d(30, 0, 0), Vector3d(30, 30, 0), Vector3d(0, 30, 0)}) {
    screws.push_back(s.add("s" + std::to_string(screws.size() + 1), screw(), at - Vector3d(0, 0, 10)));
    lid = shapes::joined(lid, shapes::moved(shapes::tube(1.7, 14, -3, 0, 64), shapes::shift(at)));
    base = shapes::joined(base, shapes::moved(shapes::tube(1.25, 14, -20, -3, 64), shapes::shift(at)));
  }
  const PartId lid_id = s.add("lid", lid), base_id = s.add("base", base);
  const Assembly assembly = s.assembly();
  const Vector3d down = -Vector3d::UnitZ();
  const StepVerdict first = judge(ToolAccess(), assembly, {screws[2]}, {lid_id, base_id}, down);
  ASSERT_EQ(first.notes.size(), 2u);
  EXPECT_EQ(first.notes[1].kind, "tool_access.pattern");
  EXPECT_EQ(first.notes[1].text,
            "4 equal screws (M3x10) clamp 'lid': put all of them in by hand first, then tighten them in cross order: "
            "'s1', 's3', 's2' and 's4'.");
  EXPECT_EQ(judge(ToolAccess(), assembly, {screws[0]}, {lid_id, base_id, screws[2]}, down).notes.size(), 1u);
  EXPECT_EQ(judge(ToolAccess(), assembly, screws, {lid_id, base_id}, down).notes.size(), 5u);
}

/// The parts have no play in each other.
void press_fit(Assembly& assembly, PartId a, PartId b, const Vector3d& axis) {
  InitialOverlap overlap;
  overlap.a = std::min(a, b), overlap.b = std::max(a, b), overlap.depth = 1e-4;
  overlap.place = OverlapPlace{};
  overlap.place->contact = ContactClass::uniform_interference;
  overlap.place->axis = axis;
  assembly.overlaps.push_back(overlap);
}

// A pin that is pressed in needs room above it: for a mallet, in a well for a punch, under a roof there is none.
TEST(ToolAccess, APinIsDrivenIn) {
  Rng rng(4);
  for (const char* unit : {"mm", "inch"}) {
    Scene s;
    const PartId pin = s.add("pin", shapes::tube(0, 2, -16, 0, 48));
    const PartId block = s.add("block", shapes::tube(2, 30, -40, 0, 96));
    const PartId well = s.add("well", wall(8, 30)), roof = s.add("roof", shapes::box({-40, -40, 10}, {40, 40, 14}));
    const Pose pose = shapes::random_pose(rng, 30);
    Assembly assembly = s.assembly(pose, rng.uniform(0.01, 2), unit);
    const Vector3d down = pose.q * -Vector3d::UnitZ();
    EXPECT_TRUE(judge(ToolAccess(), assembly, {pin}, {block}, down).notes.empty());  // it may slide
    press_fit(assembly, pin, block, down);
    StepVerdict v = judge(ToolAccess(), assembly, {pin}, {block}, down);
    EXPECT_EQ(v.cost, 0);
    nlohmann::json data = data_of(v, "tool");
    EXPECT_EQ(data["tool"], "mallet");
    EXPECT_LT((Vector3d(data["from"][0], data["from"][1], data["from"][2]) + down).norm(), 1e-3);
    EXPECT_NE(v.notes[0].text.find("(pin of 4 mm)"), std::string::npos) << v.notes[0].text;
    EXPECT_NE(v.notes[0].text.find("it has no play in 'block'"), std::string::npos) << v.notes[0].text;
    EXPECT_EQ(data_of(judge(ToolAccess(), assembly, {pin}, {block, well}, down), "tool")["tool"], "punch_and_mallet");
    v = judge(ToolAccess(), assembly, {pin}, {block, roof}, down);
    EXPECT_EQ(v.cost, 1);
    EXPECT_EQ(data_of(v, "blocked")["in_the_way"], nlohmann::json::array({"roof"}));
    // It comes with the block.
    EXPECT_TRUE(judge(ToolAccess(), assembly, {pin, block}, {roof}, down).notes.empty());
  }
}

TEST(ToolAccess, ABearingDeepInABoreNeedsASleeve) {
  Scene s;
  const PartId bearing = s.add("Ball Bearing 8 x 22 x 7", solids::ring(22, 8, 7), {0, 0, -30});
  const PartId bore = s.add("bore", shapes::tube(11, 40, -50, 0, 96));
  const PartId shaft = s.add("shaft", shapes::tube(0, 3.9, -60, 10, 48));
  Assembly assembly = s.assembly();
  press_fit(assembly, bearing, bore, Vector3d::UnitZ());
  for (const auto& present : {std::vector<PartId>{bore}, {bore, shaft}}) {
    const StepVerdict v = judge(ToolAccess(), assembly, {bearing}, present, -Vector3d::UnitZ());
    EXPECT_EQ(v.cost, 0);
    const std::string tool = data_of(v, "tool")["tool"];
    EXPECT_EQ(tool.find("press_sleeve_"), 0u) << tool;
  }
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
  const Assembly assembly = scene.assembly();
  StepVerdict v = judge(ToolAccess(), assembly, {ring}, {shaft}, -Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 0);
  EXPECT_NE(std::string(data_of(v, "tool")["tool"]).find("pliers"), std::string::npos);
  v = judge(ToolAccess(), assembly, {ring}, {shaft, bore}, -Vector3d::UnitZ());
  EXPECT_EQ(v.cost, 1);
  EXPECT_EQ(data_of(v, "blocked")["in_the_way"], nlohmann::json::array({"bore"}));
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
  const ToolAccess two(ToolAccessParams{.only = "hex_driver_2.5, hex_key_2.5"});
  EXPECT_EQ(judge(two, assembly, {second}, {plate_id, first}, down, &previous).cost, 0);
}

TEST(ToolAccess, UnknownToolsAndFilesAreErrors) {
  EXPECT_THROW(ToolAccess(ToolAccessParams{.only = "hex_key_2.5, spanner"}), ConfigError);
  EXPECT_THROW(ToolAccess(ToolAccessParams{.catalogue = "/no/such/tools.yaml"}), InputError);
}

}  // namespace
}  // namespace dismantle::checks
