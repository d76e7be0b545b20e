// Laws on STEP files of random boxes and cylinders, written by Open CASCADE and read by the reader program.
#include <gtest/gtest.h>

#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>
#include <cctype>
#include <map>
#include <numbers>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/preparation/read_input.h"
#include "reader/product_names.h"
#include "read_step.h"
#include "scratch.h"
#include "step_files.h"
#include "step_importer.h"

namespace dismantle::step_import {
namespace {

using namespace testing;

const RawPart& part_of(const Read& in, const std::string& name) {
  for (const auto& part : in.parts)
    if (part.name == name) return part;
  throw std::runtime_error("no part " + name);
}

/// Closed without any repair: each directed edge is matched by its opposite.
void expect_watertight(const RawPart& part) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& t : part.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      ++uses[{t[k], t[(k + 1) % 3]}];
      --uses[{t[(k + 1) % 3], t[k]}];
    }
  for (const auto& [edge, balance] : uses) ASSERT_EQ(balance, 0) << part.name;
}

/// Preparation finds nothing to repair.
void expect_nothing_to_repair(const Read& in) {
  PrepareOptions options;
  options.drop_duplicates = false;
  options.subdivide = 0;
  PrepareReport report;
  RunContext context;
  prepare_assembly(in.parts, "test", "", options, context, report);
  for (const auto& part : report.parts) {
    EXPECT_TRUE(part.kept) << part.name << ": " << part.reason;
    EXPECT_TRUE(part.actions.empty()) << part.name << ": " << part.actions.front();
  }
}

Eigen::Vector3d apply(const gp_Trsf& t, double x, double y, double z) {
  gp_XYZ p(x, y, z);
  t.Transforms(p);
  return {p.X(), p.Y(), p.Z()};
}

gp_Trsf random_place(Rng& rng) {
  return turned(gp_Vec(rng.normal(), rng.normal(), rng.normal()), rng.uniform(0, 6),
                gp_Vec(rng.uniform(-50, 50), rng.uniform(-50, 50), rng.uniform(-50, 50)));
}

TEST(StepImporter, NestedAssembliesPlaceRepeatedPartsInTheFilesOwnUnit) {
  Rng rng(1);
  const struct {
    const char* name;
    const char* said;
    double millimetres;
  } units[] = {{"MM", "mm", 1}, {"INCH", "inch", 25.4}, {"M", "m", 1000}, {"CM", "cm", 10}};
  for (const auto& unit : units)
    for (int round = 0; round < 3; ++round) {
      const double x = rng.uniform(1, 20), y = rng.uniform(1, 20), z = rng.uniform(1, 20), r = rng.uniform(1, 9),
                   h = rng.uniform(1, 30);
      const gp_Trsf a = random_place(rng), b = random_place(rng), inner = random_place(rng), pin = random_place(rng);
      StepFile out;
      const TDF_Label root = out.assembly("machine"), sub = out.assembly("unit");
      const TDF_Label block = out.product(box(x, y, z), "block"), bolt = out.product(cylinder(r, h), "bolt");
      out.place(sub, block, inner, "block:1");
      out.place(sub, bolt, pin, "bolt:1");
      out.place(root, sub, a, "left");
      out.place(root, sub, b, "right");
      Scratch scratch;
      out.write(scratch / "a.step", unit.name);
      SCOPED_TRACE(unit.name);
      const Read in = read(scratch / "a.step");
      ASSERT_EQ(names(in), (std::vector<std::string>{"block", "bolt", "block#2", "bolt#2"}));
      EXPECT_EQ(in.parts[0].parents, (std::vector<std::string>{"machine", "left"}));
      EXPECT_EQ(in.parts[3].parents, (std::vector<std::string>{"machine", "right"}));
      const double mm = unit.millimetres;
      for (std::size_t i = 0; i < 4; ++i) {
        const RawPart& part = in.parts[i];
        EXPECT_EQ(part.unit, unit.said);
        expect_watertight(part);
        const double volume = signed_volume(part.mesh) * mm * mm * mm;
        if (i % 2 == 0)
          EXPECT_NEAR(volume, x * y * z, 1e-9 * x * y * z);
        else  // inscribed: smaller, by at most what the angle allows
          EXPECT_NEAR(volume / (std::numbers::pi * r * r * h), 0.985, 0.015);
        const gp_Trsf place = (i < 2 ? a : b) * (i % 2 == 0 ? inner : pin);
        if (i % 2 == 0) {
          Eigen::Vector3d centre(0, 0, 0);
          for (const auto& v : part.mesh.vertices) centre += v / double(part.mesh.vertices.size());
          EXPECT_LT((centre * mm - apply(place, x / 2, y / 2, z / 2)).norm(), 1e-6);
        }
        // Each corner of a box is a vertex, however it is placed.
        for (int corner = 0; i % 2 == 0 && corner < 8; ++corner) {
          const Eigen::Vector3d at = apply(place, corner & 1 ? x : 0, corner & 2 ? y : 0, corner & 4 ? z : 0);
          double nearest = 1e9;
          for (const auto& v : part.mesh.vertices) nearest = std::min(nearest, (v * mm - at).norm());
          EXPECT_LT(nearest, 1e-6);
        }
      }
      expect_nothing_to_repair(in);
      EXPECT_NE(in.log.find(std::string("lengths in ") + unit.said), std::string::npos) << in.log;
    }
}

TEST(StepImporter, ColoursOfInstancesProductsSolidsAndFaces) {
  const Rgba red{255, 0, 0, 255}, green{10, 200, 30, 255}, blue{0, 0, 254, 255}, grey{128, 128, 128, 255};
  StepFile out;
  const TDF_Label root = out.assembly("root");
  const TopoDS_Shape cube = box(10, 10, 10), flat = box(10, 10, 1), plain_box = box(3, 3, 3);
  const TDF_Label painted = out.product(cube, "painted"), faces = out.product(flat, "faces"),
                  plain = out.product(plain_box, "plain");
  out.paint(painted, red);
  out.paint(faces, grey);
  int face = 0;
  for (TopExp_Explorer it(flat, TopAbs_FACE); it.More(); it.Next(), ++face)
    if (face >= 4) out.paint(faces, it.Current(), blue);  // z = 0 and z = 1: most of its area
  out.place(root, painted, moved(0, 0, 0), "as it is");
  out.paint(out.place(root, painted, moved(20, 0, 0), "over"), green);
  out.place(root, faces, moved(40, 0, 0), "f");
  out.place(root, plain, moved(60, 0, 0), "p");
  Scratch scratch;
  out.write(scratch / "a.step");
  const Read in = read(scratch / "a.step");
  ASSERT_EQ(in.parts.size(), 4u);
  EXPECT_EQ(in.parts[0].colour, red);
  EXPECT_EQ(in.parts[1].colour, green);
  EXPECT_EQ(in.parts[2].colour, blue);
  EXPECT_EQ(in.parts[3].colour, std::nullopt);
}

TEST(StepImporter, SolidsOfOneProductAreParts) {
  StepFile out;
  TopoDS_Compound two;
  BRep_Builder builder;
  builder.MakeCompound(two);
  builder.Add(two, box(1, 1, 1));
  builder.Add(two, box(2, 2, 2).Moved(TopLoc_Location(moved(5, 0, 0))));
  const TDF_Label root = out.assembly("root");
  out.place(root, out.product(two, "pair"), moved(0, 0, 0));
  out.place(root, out.product(box(3, 3, 3), "pair:1"), moved(0, 9, 0));
  Scratch scratch;
  out.write(scratch / "a.step");
  const Read in = read(scratch / "a.step");
  ASSERT_EQ(in.parts.size(), 3u);
  double volume = 0;
  std::set<std::string> different;
  for (const auto& part : in.parts) {
    EXPECT_EQ(part.name.rfind("pair:", 0), 0u) << part.name;
    different.insert(part.name);
    volume += signed_volume(part.mesh);
  }
  EXPECT_EQ(different.size(), 3u);
  EXPECT_NEAR(volume, 1 + 8 + 27, 1e-9);
}

TEST(StepImporter, FinerDeflectionIsCloserAndStaysClosed) {
  StepFile out;
  const TDF_Label root = out.assembly("root");
  out.place(root, out.product(BRepPrimAPI_MakeSphere(10).Shape(), "ball"), moved(0, 0, 0));
  out.place(root, out.product(cylinder(1, 40), "rod"), moved(30, 0, 0));
  Scratch scratch;
  out.write(scratch / "a.step");
  double before = 1;
  std::size_t triangles = 0;
  for (const double share : {0.05, 0.01, 0.002, 0.0004}) {
    StepParameters params;
    params.linear_deflection = share;
    params.assembly_deflection = 0;
    params.angular_deflection = 1.5;
    const Read in = read(scratch / "a.step", params);
    for (const auto& part : in.parts) expect_watertight(part);
    const RawPart& ball = part_of(in, "ball");
    const double missing = 1 - signed_volume(ball.mesh) / (4.0 / 3 * std::numbers::pi * 1000);
    EXPECT_LT(missing, before);
    EXPECT_GT(ball.mesh.triangles.size(), triangles);
    // No chord is deeper inside than the tolerance, a share of the diagonal 20 * sqrt(3).
    for (const auto& t : ball.mesh.triangles) {
      const Eigen::Vector3d middle =
          (ball.mesh.vertices[t[0]] + ball.mesh.vertices[t[1]] + ball.mesh.vertices[t[2]]) / 3;
      EXPECT_GT(middle.norm(), 10 - 2 * share * 20 * std::numbers::sqrt3);
    }
    before = missing;
    triangles = ball.mesh.triangles.size();
  }
  StepParameters few;
  few.triangle_limit = 100;
  const std::string error = input_error([&] { read(scratch / "a.step", few); });
  EXPECT_NE(error.find("more than 100 triangles"), std::string::npos) << error;
}

TEST(StepImporter, ReadingTwiceGivesTheSame) {
  StepFile out;
  const TDF_Label root = out.assembly("root");
  out.place(root, out.product(BRepPrimAPI_MakeSphere(10).Shape(), "ball"), moved(0.1, 0.2, 0.3));
  out.place(root, out.product(cylinder(3, 40), "rod"), turned(gp_Vec(1, 2, 3), 1, gp_Vec(30, 0, 0)));
  Scratch scratch;
  out.write(scratch / "a.step");
  const Read a = read(scratch / "a.step"), b = read(scratch / "a.step");
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    EXPECT_EQ(a.parts[i].mesh.vertices, b.parts[i].mesh.vertices);
    EXPECT_EQ(a.parts[i].mesh.triangles, b.parts[i].mesh.triangles);
  }
}

std::string sample_text() {
  StepFile out;
  const TDF_Label root = out.assembly("root");
  out.place(root, out.product(box(1, 2, 3), "block"), moved(0, 0, 0));
  out.place(root, out.product(cylinder(1, 2), "bolt"), moved(5, 0, 0));
  Scratch scratch;
  out.write(scratch / "a.step");
  std::ifstream file(scratch / "a.step", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(StepImporter, DamageGivesPartsOrAnInputError) {
  const std::string whole = sample_text();
  Scratch scratch;
  StepParameters params;
  params.time_limit = 20;
  params.memory_limit = 2048;
  Rng rng(7);
  int refused = 0;
  for (int round = 0; round < 60; ++round) {
    std::string bytes = whole;
    const std::size_t data = bytes.find("DATA;");
    switch (round % 4) {
      case 0:  // any byte
        for (auto n = 1 + rng.below(20); n-- > 0;) bytes[rng.below(bytes.size())] = static_cast<char>(rng.below(256));
        break;
      case 1:  // a reference to another entity
        for (auto n = 1 + rng.below(10); n-- > 0;)
          if (const auto at = bytes.find('#', data + rng.below(bytes.size() - data)); at + 1 < bytes.size())
            bytes[at + 1] = static_cast<char>('0' + rng.below(10));
        break;
      case 2: {  // a piece is missing, but not the end
        const std::size_t from = data + rng.below(bytes.size() - data - 60);
        bytes.erase(from, std::min<std::size_t>(rng.below(2000), bytes.size() - 60 - from));
        break;
      }
      default:  // cut off
        bytes.resize(rng.below(bytes.size()));
    }
    const auto file = scratch.write("a.step", bytes);
    const std::string error = input_error([&] {
      for (const auto& part : read(file, params).parts) {
        EXPECT_TRUE(!part.problem.empty() || !part.mesh.empty());
        for (const auto& v : part.mesh.vertices) EXPECT_TRUE(v.allFinite());
      }
    });
    if (error.empty()) continue;
    ++refused;
    EXPECT_NE(error.find("a.step: "), std::string::npos) << error;
    EXPECT_TRUE(std::none_of(error.begin(), error.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }))
        << error;
  }
  EXPECT_GE(refused, 15);  // at least all truncated ones
}

TEST(StepImporter, TheMemoryLimitIsNamed) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers take terabytes of address space";
#endif
  Scratch scratch;
  const auto file = scratch.write("a.step", sample_text());
  StepParameters params;
  params.memory_limit = 40;  // not enough to load Open CASCADE
  const std::string error = input_error([&] { read(file, params); });
  EXPECT_NE(error.find("more memory than 40 MiB: raise importers.step.memory_limit"), std::string::npos) << error;
  // Just enough for two small parts is not enough for a hundred thousand triangles.
  double low = 40, high = 4000;
  while (high - low > 4) {
    params.memory_limit = (low + high) / 2;
    (input_error([&] { read(file, params); }).empty() ? high : low) = params.memory_limit;
  }
  StepFile out;
  const TDF_Label root = out.assembly("root");
  for (int i = 0; i < 4; ++i)
    out.place(root, out.product(BRepPrimAPI_MakeSphere(10 + i).Shape(), "ball"), moved(30 * i, 0, 0));
  out.write(scratch / "b.step");
  params.linear_deflection = 1e-5;
  params.angular_deflection = 0.01;  // gigabytes
  params.memory_limit = high;
  const std::string large = input_error([&] { read(scratch / "b.step", params); });
  EXPECT_NE(large.find("more memory than"), std::string::npos) << large;
}

TEST(StepNames, DirectivesAreDecoded) {
  EXPECT_EQ(decoded("Geh\\X2\\00E4\\X0\\use"), "Geh\xC3\xA4use");
  EXPECT_EQ(decoded("\\X2\\90E854C1\\X0\\"), "\xE9\x83\xA8\xE5\x93\x81");
  EXPECT_EQ(decoded("\\X4\\0001F529\\X0\\"), "\xF0\x9F\x94\xA9");
  EXPECT_EQ(decoded("\\X2\\D83DDD29\\X0\\"), "\xF0\x9F\x94\xA9");
  EXPECT_EQ(decoded("Pe\\X\\E7a"),
            "Pe\xC3\xA7"
            "a");
  EXPECT_EQ(decoded("\\S\\d"), "\xC3\xA4");
  EXPECT_EQ(decoded("a\\\\b"), "a\\b");
  for (const char* broken : {"\\X2\\00", "\\X2\\ZZZZ\\X0\\", "\\X\\G", "\\X4\\FFFFFFFF\\X0\\", "\\", "\\S\\"})
    EXPECT_EQ(decoded(broken), broken);
  for (const char* name : {"Gehäuse", "部品 2", "a'b\"c", "🔩"}) {
    StepFile out;
    const TDF_Label root = out.assembly("root");
    out.place(root, out.product(box(1, 1, 1), name), moved(0, 0, 0));
    Scratch scratch;
    out.write(scratch / "a.step");
    EXPECT_EQ(names(read(scratch / "a.step")), std::vector<std::string>{name});
  }
}

TEST(StepNames, NoNameIsTakenTwiceAndGivenOnesStay) {
  Rng rng(4);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::string> given, now;
    for (auto n = rng.below(30); n-- > 0;) {
      std::string name = rng.below(2) ? "nut" : "bolt";
      if (rng.below(3) == 0) name += "#" + std::to_string(1 + rng.below(4));
      given.push_back(name);
    }
    now = given;
    std::vector<std::string*> names;
    for (auto& name : now) names.push_back(&name);
    make_unique(names);
    std::set<std::string> different(now.begin(), now.end()), seen;
    EXPECT_EQ(different.size(), now.size());
    for (std::size_t i = 0; i < now.size(); ++i) {
      EXPECT_EQ(now[i].rfind(given[i], 0), 0u);
      if (seen.insert(given[i]).second) {
        EXPECT_EQ(now[i], given[i]);
      }
    }
  }
}

}  // namespace
}  // namespace dismantle::step_import
