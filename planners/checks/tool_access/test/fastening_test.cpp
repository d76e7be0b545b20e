// Nuts and their screws, orders of screws, pins and bearings.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "dismantle/fasteners/recognise.h"
#include "scene.h"

namespace dismantle::checks {
namespace {

using namespace test;

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

// A nut without its bolt falls off, unless a pocket keeps it: it comes later. Sizes of tables and a drive change
// nothing.
TEST(ToolAccess, ANutComesAfterItsBolt) {
  Bolted known;
  Bolted named;
  named.meshes[named.bolt] = shapes::moved(solids::screw({3.1, 12, 7, 4.5}), shapes::shift({0, 0, -12}));
  named.meshes[named.nut] = shapes::moved(solids::nut(solids::polygon(4, 8), 3.1, 1), shapes::shift({0, 0, -9}));
  for (Bolted* s : {&known, &named}) {
    const auto corners = s == &known ? solids::polygon(6, 5.8) : solids::polygon(4, 8.2);
    const PartId pocket = s->add(
        "pocket",
        solids::turned_solid({{-30, solids::circle(24)}, {-8, solids::circle(24)}, {-8, corners}, {-30, corners}}));
    Assembly assembly = s->assembly();
    fasteners::recognise_kinds(assembly, RunContext{});
    const Vector3d up = Vector3d::UnitZ();
    const StepVerdict v = judge(ToolAccess(), assembly, {s->nut}, {s->upper, s->lower}, up);
    EXPECT_EQ(v.cost, 1);
    EXPECT_EQ(v.reason, "'nut' is put in before its screw 'bolt'");
    EXPECT_EQ(data_of(v, "early")["missing"], nlohmann::json::array({"bolt"}));
    EXPECT_EQ(judge(ToolAccess(), assembly, {s->nut}, {s->upper, s->lower, s->bolt}, up).cost, 0);
    EXPECT_EQ(judge(ToolAccess(), assembly, {s->nut}, {s->upper, s->lower}, Vector3d::UnitX()).cost, 1);
    EXPECT_EQ(data_of(judge(ToolAccess(), assembly, {s->bolt}, {s->upper, s->lower}, -up), "later")["nut"], "nut");
    EXPECT_EQ(judge(ToolAccess(), assembly, {s->nut}, {s->upper, s->lower, pocket}, up).cost, 0);
  }
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
  EXPECT_EQ(v.reason, "'screw' is tightened before what it fastens is there");
  ASSERT_EQ(v.notes.size(), 2u);
  EXPECT_EQ(v.notes[1].kind, "tool_access.early");
  EXPECT_EQ(v.notes[1].text, "'screw' is tightened too early: it clamps 'lid', which is not there yet.");
  const StepVerdict loose = judge(ToolAccess(), assembly, {screw_id}, {lid}, -Vector3d::UnitZ());
  EXPECT_EQ(loose.cost, 1);
  ASSERT_EQ(loose.notes.size(), 2u);
  EXPECT_EQ(loose.notes[1].text, "'screw' is put in too early: it is driven into 'base', which is not there yet.");
}

// The first of four equal screws says how they are tightened, the others do not.
TEST(ToolAccess, APatternIsTightenedCrosswise) {
  Scene s;
  const FourScrews pattern(s);
  const Assembly assembly = s.assembly();
  const Vector3d down = -Vector3d::UnitZ();
  const StepVerdict first = judge(ToolAccess(), assembly, {pattern.screws[2]}, {pattern.lid, pattern.base}, down);
  ASSERT_EQ(first.notes.size(), 2u);
  EXPECT_EQ(first.notes[1].kind, "tool_access.pattern");
  EXPECT_EQ(first.notes[1].text,
            "4 equal screws (M3x10) clamp 'lid': put all of them in by hand first, then tighten them in cross order: "
            "'s1', 's3', 's2' and 's4'.");
  EXPECT_EQ(judge(ToolAccess(), assembly, {pattern.screws[0]}, {pattern.lid, pattern.base, pattern.screws[2]}, down)
                .notes.size(),
            1u);
  EXPECT_EQ(judge(ToolAccess(), assembly, pattern.screws, {pattern.lid, pattern.base}, down).notes.size(), 5u);
}

/// The parts overlap by this depth in mm, all around.
void press_fit(Assembly& assembly, PartId a, PartId b, const Vector3d& axis, double depth = 0.1) {
  InitialOverlap overlap;
  overlap.a = std::min(a, b), overlap.b = std::max(a, b),
  overlap.depth = depth / fasteners::millimetres_per_unit(assembly);
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
    EXPECT_NE(v.notes[0].text.find("has no play in 'block': mallet"), std::string::npos) << v.notes[0].text;
    EXPECT_EQ(data_of(judge(ToolAccess(), assembly, {pin}, {block, well}, down), "tool")["tool"], "punch_and_mallet");
    v = judge(ToolAccess(), assembly, {pin}, {block, roof}, down);
    EXPECT_EQ(v.cost, 1);
    EXPECT_EQ(data_of(v, "blocked")["in_the_way"], nlohmann::json::array({"roof"}));
    // It comes with the block.
    EXPECT_TRUE(judge(ToolAccess(), assembly, {pin, block}, {roof}, down).notes.empty());
  }
}

// Two cylinders of one diameter overlap by their facets: this does not show whether they are pressed.
TEST(ToolAccess, APinOfTheSizeOfItsHoleMayGoInByHand) {
  Scene s;
  const PartId pin = s.add("pin", shapes::tube(0, 2, -16, 0, 48));
  const PartId block = s.add("block", shapes::tube(2, 30, -40, 0, 96));
  const PartId roof = s.add("roof", shapes::box({-40, -40, 10}, {40, 40, 14}));
  Assembly assembly = s.assembly();
  press_fit(assembly, pin, block, Vector3d::UnitZ(), 0.005);
  const std::vector<PlacedPart> nothing;
  const StepQuestion previous{assembly, nothing, {}};
  const StepVerdict v = judge(ToolAccess(), assembly, {pin}, {block}, -Vector3d::UnitZ(), &previous);
  EXPECT_EQ(v.cost, 0);
  EXPECT_NE(v.notes.at(0).text.find("if it does not go in by hand, mallet"), std::string::npos) << v.notes[0].text;
  EXPECT_EQ(data_of(v, "tool")["by_hand"], true);
  const StepVerdict blocked = judge(ToolAccess(), assembly, {pin}, {block, roof}, -Vector3d::UnitZ(), &previous);
  EXPECT_EQ(blocked.cost, 0);
  EXPECT_TRUE(blocked.notes.empty());
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

}  // namespace
}  // namespace dismantle::checks
