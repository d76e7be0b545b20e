#include "dismantle/fasteners/shape.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "solids.h"

namespace dismantle::fasteners {
namespace {

using namespace test;

struct Made {
  std::string what;
  Mesh mesh;
  Kind kind;
  std::string size;
  double length = 0;
  Drive drive = Drive::none;
};

struct Row {
  const char* name;
  double diameter, pitch, head, head_height, key, nut, nut_height, hole, outside, thickness;
};
// ISO 4762, 4032, 7089.
constexpr Row kRows[] = {
    {"M2", 2, .4, 3.8, 2, 1.5, 4, 1.6, 2.2, 5, .3},    {"M3", 3, .5, 5.5, 3, 2.5, 5.5, 2.4, 3.2, 7, .5},
    {"M4", 4, .7, 7, 4, 3, 7, 3.2, 4.3, 9, .8},        {"M5", 5, .8, 8.5, 5, 4, 8, 4.7, 5.3, 10, 1},
    {"M6", 6, 1, 10, 6, 5, 10, 5.2, 6.4, 12, 1.6},     {"M8", 8, 1.25, 13, 8, 6, 13, 6.8, 8.4, 16, 1.6},
    {"M10", 10, 1.5, 16, 10, 8, 16, 8.4, 10.5, 20, 2}, {"M12", 12, 1.75, 18, 12, 10, 18, 10.8, 13, 24, 2.5},
};

std::vector<Made> standard_parts() {
  std::vector<Made> out;
  for (const Row& r : kRows) {
    const double d = r.diameter;
    for (const double length : {10.0, 20.0, 40.0}) {
      if (length < d) continue;
      ScrewMade cap{d, length, r.head, r.head_height, {}, polygon(6, r.key), 0.5 * r.head_height};
      out.push_back({"cap screw", screw(cap), Kind::screw, r.name, length, Drive::hex_socket});
      cap.pitch = r.pitch;
      if (length == 20)
        out.push_back({"threaded cap screw", screw(cap), Kind::screw, r.name, length, Drive::hex_socket});
      out.push_back({"hexagon bolt", screw({d, length, r.nut, 0.65 * d, polygon(6, r.nut)}), Kind::screw, r.name,
                     length, Drive::outer_hex});
      out.push_back({"cross screw", screw({d, length, 2 * d, 0.7 * d, {}, cross(1.1 * d, 0.25 * d), 0.4 * d}),
                     Kind::screw, r.name, length, Drive::cross});
      ScrewMade sunk{d, length, 1.9 * d, 0, {}, cross(1.1 * d, 0.25 * d), 0.3 * d};
      sunk.countersunk = true;
      out.push_back({"countersunk screw", screw(sunk), Kind::screw, r.name, length, Drive::cross});
    }
    out.push_back({"set screw", screw({d, 2 * d, 0, 0, {}, polygon(6, d / 2), 0.6 * d}), Kind::screw, r.name, 2 * d,
                   Drive::hex_socket});
    out.push_back({"nut", nut(polygon(6, r.nut), d, r.nut_height), Kind::nut, r.name});
    out.push_back(
        {"nut with a core hole", nut(polygon(6, r.nut), d - 1.0825 * r.pitch, r.nut_height), Kind::nut, r.name});
    out.push_back(
        {"threaded nut", nut(polygon(6, r.nut), d - 1.0825 * r.pitch, r.nut_height, r.pitch), Kind::nut, r.name});
    out.push_back({"washer", ring(r.outside, r.hole, r.thickness), Kind::washer, r.name});
  }
  out.push_back({"Torx screw", screw({4, 16, 8, 3, {}, torx(3.95), 1.8}), Kind::screw, "M4", 16, Drive::torx});
  return out;
}

std::vector<Made> other_parts() {
  std::vector<Made> out;
  out.push_back({"spacer", ring(10, 5.1, 6), Kind::spacer, ""});
  out.push_back(
      {"pin", turned_solid({{0, circle(0)}, {0, circle(3)}, {12, circle(3)}, {12, circle(0)}}), Kind::pin, "3"});
  out.push_back(
      {"shaft", turned_solid({{0, circle(0)}, {0, circle(8)}, {290, circle(8)}, {290, circle(0)}}), Kind::shaft, ""});
  out.push_back({"stand-off", nut(polygon(6, 5.5), 2.5, 20), Kind::standoff, "M3"});
  out.push_back({"block", nut(polygon(4, 40), 5, 25), Kind::other, ""});
  // A knob of no size in a table, without a drive: a turned part, no screw.
  out.push_back({"knob", screw({7.3, 10, 23, 17}), Kind::other, ""});
  out.push_back({"plate", turned_solid({{0, polygon(4, 80)}, {3, polygon(4, 80)}, {3, circle(0)}, {0, circle(0)}}, 144),
                 Kind::plate, ""});
  return out;
}

TEST(RecogniseShape, NamesStandardPartsAtRandomPosesInAnyUnit) {
  std::mt19937_64 random(55);
  const double units[] = {1.0, 1000.0, 25.4};
  std::size_t count = 0;
  for (const Made& made : standard_parts())
    for (const double mm : {units[count++ % 3], 0.37}) {
      const Shape shape = recognise_shape(placed(made.mesh, random, 1 / mm), mm);
      SCOPED_TRACE(fmt::format("{} {} x {}, {} mm in a unit: {} {} ({})", made.what, made.size, made.length, mm,
                               to_string(shape.kind), shape.size, shape.reason));
      EXPECT_EQ(shape.kind, made.kind);
      EXPECT_EQ(shape.size, made.size);
      EXPECT_EQ(shape.drive, made.kind == Kind::nut ? Drive::outer_hex : made.drive);
      if (made.length > 0) {
        EXPECT_NEAR(shape.length, made.length, 1e-6);
      }
      EXPECT_GE(shape.confidence, 0.5);
      EXPECT_FALSE(shape.reason.empty());
    }
}

TEST(RecogniseShape, OtherPartsAreNoScrews) {
  std::mt19937_64 random(56);
  for (const Made& made : other_parts()) {
    const Shape shape = recognise_shape(placed(made.mesh, random, 1), 1);
    SCOPED_TRACE(fmt::format("{}: {} {} ({})", made.what, to_string(shape.kind), shape.size, shape.reason));
    EXPECT_EQ(shape.kind, made.kind);
    if (!made.size.empty()) {
      EXPECT_EQ(shape.size, made.size);
    }
  }
}

TEST(RecogniseShape, AScaledCopyHasTheSizeOfItsTrueSize) {
  std::mt19937_64 random(57);
  const Mesh m3 = screw({3, 12, 5.5, 3, {}, polygon(6, 2.5), 1.5});
  const Shape twice = recognise_shape(placed(m3, random, 2), 1);
  EXPECT_EQ(twice.kind, Kind::screw);
  EXPECT_EQ(twice.size, "M6");
  EXPECT_NEAR(twice.length, 24, 1e-6);
  // No table has a screw a hundred times as large: the kind stays, the size is not known, and that is said.
  const Shape huge = recognise_shape(placed(m3, random, 100), 1);
  EXPECT_EQ(huge.kind, Kind::screw);
  EXPECT_EQ(huge.size, "");
  EXPECT_NE(huge.reason.find("in no table"), std::string::npos) << huge.reason;
}

TEST(RecogniseShape, AxisRunsFromTipToHead) {
  std::mt19937_64 random(58);
  for (int i = 0; i < 20; ++i) {
    Mesh mesh = screw({5, 20, 8.5, 5, {}, polygon(6, 4), 2.5});
    mesh.vertices.emplace_back(0, 0, 25);  // three points that no triangle uses show where the axis is
    mesh.vertices.emplace_back(0, 0, 0);
    const Mesh at = placed(mesh, random, 0.1);
    Mesh used = at;
    const Eigen::Vector3d tip = used.vertices.back();
    used.vertices.pop_back();
    const Eigen::Vector3d top = used.vertices.back();
    used.vertices.pop_back();
    const Shape shape = recognise_shape(used, 10);
    EXPECT_GT(shape.axis.dot((top - tip).normalized()), 0.99999);
    EXPECT_LT((shape.top - top).norm(), 1e-3 * (top - tip).norm());
    EXPECT_NEAR(shape.recess_depth, 0.25, 0.02);
  }
}

TEST(RecogniseShape, AnEmptyMeshIsOther) { EXPECT_EQ(recognise_shape(Mesh{}, 1).kind, Kind::other); }

}  // namespace
}  // namespace dismantle::fasteners
