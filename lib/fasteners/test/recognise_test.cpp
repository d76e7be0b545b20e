#include "dismantle/fasteners/recognise.h"

#include <gtest/gtest.h>

#include "solids.h"

namespace dismantle::fasteners {
namespace {

using namespace test;

Shape shape_of(Kind kind, double confidence, std::string size = "", double length = 0) {
  Shape s;
  s.kind = kind;
  s.confidence = confidence;
  s.size = std::move(size);
  s.length = length;
  s.reason = "shape";
  return s;
}

TEST(CombinedKind, AgreementIsSurerThanEither) {
  const PartKind kind = combined(shape_of(Kind::screw, 0.9, "M4", 20), recognise_name("DIN 912 M4x20"));
  EXPECT_EQ(kind.kind, "screw");
  EXPECT_EQ(kind.size, "M4x20");
  EXPECT_GT(kind.confidence, 0.95);
  EXPECT_EQ(kind.reason.find("disagree"), std::string::npos) << kind.reason;
}

TEST(CombinedKind, SaysWhereShapeAndNameDisagree) {
  const PartKind size = combined(shape_of(Kind::screw, 0.9, "M4", 25), recognise_name("DIN 912 M4x20"));
  EXPECT_EQ(size.size, "M4x25");
  EXPECT_LT(size.confidence, 0.9);
  EXPECT_NE(size.reason.find("M4x20"), std::string::npos) << size.reason;
  EXPECT_NE(size.reason.find("disagree"), std::string::npos);
  const PartKind kind = combined(shape_of(Kind::nut, 0.95, "M4"), recognise_name("M4 Washer"));
  EXPECT_EQ(kind.kind, "nut");
  EXPECT_NE(kind.reason.find("disagree"), std::string::npos) << kind.reason;
  EXPECT_NE(kind.reason.find("washer"), std::string::npos) << kind.reason;
}

TEST(CombinedKind, TheNameDecidesWhereShapesAreAlike) {
  EXPECT_EQ(combined(shape_of(Kind::spacer, 0.7), recognise_name("Ball Bearing 5 x 16 x 5")).kind, "bearing");
  EXPECT_EQ(combined(shape_of(Kind::plate, 0.7), recognise_name("main PCB")).kind, "board");
  EXPECT_EQ(combined(shape_of(Kind::other, 0), recognise_name("Nema 17 Stepper Motor")).kind, "motor");
  EXPECT_EQ(combined(shape_of(Kind::other, 0), recognise_name("Body1")).kind, "other");
}

// What the name says is round must look round: a bracket is no bearing, whatever it is called.
TEST(CombinedKind, WhatIsNotRoundIsNoBearing) {
  std::mt19937_64 random(55);
  for (const double side : {20.0, 30.0}) {
    const Shape bracket = recognise_shape(placed(nut(polygon(3, side), 8, 30), random, 1), 1);
    ASSERT_EQ(bracket.kind, Kind::other) << bracket.reason;
    EXPECT_LT(bracket.roundness, 0.55);
    for (const char* name : {"Lager", "ball bearing", "tray insert", "idler"}) {
      const PartKind kind = combined(bracket, recognise_name(name));
      EXPECT_EQ(kind.kind, "other") << name;
      EXPECT_NE(kind.reason.find("not round"), std::string::npos) << kind.reason;
    }
    EXPECT_EQ(combined(bracket, recognise_name("motor")).kind, "motor");
  }
}

TEST(CombinedKind, ACellIsNoShaft) {
  for (const char* name : {"18650", "battery", "LiPo Akku"})
    EXPECT_EQ(combined(shape_of(Kind::shaft, 0.7, "18"), recognise_name(name)).kind, "other") << name;
  EXPECT_EQ(combined(shape_of(Kind::plate, 0.7), recognise_name("battery holder")).kind, "plate");
}

Part part_of(PartId id, const char* name, Mesh mesh) {
  Part part;
  part.id = id;
  part.name = name;
  part.mesh = std::make_shared<const Mesh>(std::move(mesh));
  return part;
}

Mesh lifted(Mesh mesh, double z) {
  for (Eigen::Vector3d& p : mesh.vertices) p.z() += z;
  return mesh;
}

TEST(RecogniseKinds, UnitsOfFilesAndAssembliesCount) {
  for (const auto& [unit, mm] : {std::pair{"mm", 1.0}, {"m", 1000.0}, {"inch", 25.4}, {"", 1.0}}) {
    Assembly assembly;
    assembly.unit = unit;
    assembly.normalization.scale = 0.25;
    Mesh mesh = screw({5, 20, 8.5, 5, {}, polygon(6, 4), 2.5});
    for (Eigen::Vector3d& p : mesh.vertices) p *= 0.25 / mm;
    assembly.parts.push_back(part_of(0, "x", mesh));
    recognise_kinds(assembly, RunContext{});
    ASSERT_TRUE(assembly.parts[0].kind);
    EXPECT_EQ(assembly.parts[0].kind->size, "M5x20") << unit;
  }
}

TEST(RecogniseKinds, ARingInsideANutIsTheNuts) {
  Assembly assembly;
  assembly.parts.push_back(part_of(0, "body", nut(polygon(6, 5.5), 3, 4)));
  assembly.parts.push_back(part_of(1, "inlay", lifted(ring(4.6, 3, 0.5), 3.2)));
  assembly.parts.push_back(part_of(2, "washer", lifted(ring(7, 3.2, 0.5), -0.5)));
  recognise_kinds(assembly, RunContext{});
  EXPECT_EQ(assembly.parts[0].kind->kind, "nut");
  EXPECT_EQ(assembly.parts[1].kind->kind, "nut");
  EXPECT_EQ(assembly.parts[2].kind->kind, "washer");
}

TEST(RecogniseKinds, KeepsWhatTheUserStates) {
  Assembly assembly;
  assembly.parts.push_back(part_of(0, "body", nut(polygon(6, 5.5), 3, 2.4)));
  assembly.parts[0].kind = PartKind{"housing", "", 1, "stated", true};
  recognise_kinds(assembly, RunContext{});
  EXPECT_EQ(assembly.parts[0].kind->kind, "housing");
}

TEST(RecogniseKinds, NoNamesMeansShapesAlone) {
  Assembly assembly;
  assembly.parts.push_back(part_of(0, "DIN 912 M4x20", ring(10, 5.1, 6)));
  recognise_kinds(assembly, RunContext{}, {.names = false});
  EXPECT_EQ(assembly.parts[0].kind->kind, "spacer");
}

// A product named motor: its largest body is the motor, the others are what their shapes say.
TEST(RecogniseKinds, BodiesOfAMotorAreNoMotors) {
  for (const bool together : {true, false}) {
    Assembly assembly;
    assembly.parts.push_back(part_of(0, "servo:Body1", nut(polygon(3, 20), 8, 30)));
    assembly.parts.push_back(part_of(1, "servo:Body2", screw({5, 20, 8.5, 5, {}, polygon(6, 4), 2.5})));
    assembly.parts.push_back(part_of(2, "servo:Body3", nut(polygon(3, 10), 4, 15)));
    for (Part& part : assembly.parts) {
      part.product = "servo";
      part.volume = part.id == 0 ? 10000 : 1000;
      part.instances = {together ? "use" : "use " + part.name};
    }
    recognise_kinds(assembly, RunContext{});
    EXPECT_EQ(assembly.parts[0].kind->kind, "motor");
    EXPECT_EQ(assembly.parts[1].kind->kind, "screw");
    EXPECT_EQ(assembly.parts[2].kind->kind, together ? "other" : "motor");
    EXPECT_EQ(assembly.parts[1].kind->reason.find("disagree") == std::string::npos, together);
  }
}

TEST(PitchOf, IsThatOfTheCoarseThreadOrTheOneStated) {
  for (const auto& [size, pitch] : std::vector<std::pair<std::string, double>>{{"M6x14", 1},
                                                                               {"M3", 0.5},
                                                                               {"M2.5x8", 0.45},
                                                                               {"M8x1", 1},
                                                                               {"M8x1x20", 1},
                                                                               {"M8x3", 1.25},
                                                                               {"1/4-20x0.75", 1.27},
                                                                               {"6002", 0},
                                                                               {"8x5x1", 0},
                                                                               {"", 0}})
    EXPECT_NEAR(pitch_of(size), pitch, 1e-9) << size;
}

// A bolt and a nut of no known size: what their names say they are gives their shapes an axis, a shank and a hole.
TEST(RecogniseKinds, BoltsAndNutsByNameHaveAnAxis) {
  std::mt19937_64 random(57);
  for (const bool named : {true, false}) {
    Assembly assembly;
    assembly.parts.push_back(part_of(0, named ? "bolt" : "a", placed(screw({7.3, 30, 23, 17}), random, 1)));
    assembly.parts.push_back(part_of(1, named ? "nut" : "b", placed(nut(polygon(4, 20), 7.3, 3), random, 1)));
    assembly.parts.push_back(part_of(2, named ? "lock nut" : "c", placed(ring(20, 7.3, 3), random, 1)));
    recognise_kinds(assembly, RunContext{});
    const std::vector<Shape> shapes = shapes_of(assembly, RunContext{}), few = fastener_shapes(assembly, RunContext{});
    for (const Part& part : assembly.parts) {
      const bool fastens = part.kind->kind == "screw" || part.kind->kind == "nut";
      EXPECT_EQ(few[part.id].reason, fastens ? shapes[part.id].reason : "not looked at") << part.name;
      EXPECT_EQ(few[part.id].height, fastens ? shapes[part.id].height : 0) << part.name;
    }
    EXPECT_EQ(shapes[0].kind == Kind::screw, named);
    EXPECT_EQ(shapes[1].kind == Kind::nut, named);
    EXPECT_NE(shapes[2].kind, Kind::nut);  // a round one may be the ring of another nut
    if (!named) continue;
    EXPECT_NEAR(shapes[0].shank_radius, 3.65, 0.01);
    EXPECT_NEAR(shapes[0].head_height, 17, 0.1);
    // The first vertices of the solids are at the tip, on the axis, and at the lower side.
    EXPECT_NEAR((shapes[0].top - assembly.parts[0].mesh->vertices[0]).dot(shapes[0].axis), 47, 1e-6);
    EXPECT_NEAR(shapes[1].shank_radius, 3.65, 0.01);
    EXPECT_NEAR(std::abs((shapes[1].top - assembly.parts[1].mesh->vertices[0]).dot(shapes[1].axis)), 1.5, 1.5 + 1e-6);
  }
}

}  // namespace
}  // namespace dismantle::fasteners
