// What screws clamp and what they are driven into, at any pose and in any unit.
#include "dismantle/fasteners/fastening.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "dismantle/fasteners/recognise.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/testing/shapes.h"
#include "solids.h"

namespace dismantle::fasteners {
namespace {

using namespace test;
using Eigen::Vector3d;

/// Parts in millimetres; M3 screws stand with their heads' undersides at z = 0.
struct Stack : NamedMeshes {
  /// With a hexagon socket.
  PartId add_screw(const std::string& name, double length, const Vector3d& at = Vector3d::Zero()) {
    return add(name, screw({3, length, 5.5, 3, {}, polygon(6, 2.5), 1.5}), at - Vector3d(0, 0, length));
  }
  /// From `low` up to `high`, with a bore.
  PartId add_plate(const std::string& name, double bore, double low, double high,
                   const Vector3d& at = Vector3d::Zero()) {
    return add(name, shapes::tube(bore / 2, 12, low, high, 96), at);
  }
  /// A blind hole from z = `high` down to `ground`.
  PartId add_block(const std::string& name, double bore, double high, double ground) {
    return add(name, turned_solid({{ground - 10, circle(0)},
                                   {ground - 10, circle(24)},
                                   {high, circle(24)},
                                   {high, circle(bore)},
                                   {ground, circle(bore)},
                                   {ground, circle(0)}}));
  }
  PartId add_nut(const std::string& name, double high, double across = 5.5, double hole = 2.5, double height = 2.4) {
    return add(name, nut(polygon(6, across), hole, height), {0, 0, high - height});
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
    recognise_kinds(out, RunContext{}, {.names = false});
    return out;
  }
};

std::vector<Fastening> found_in(const Assembly& assembly) {
  std::vector<std::unique_ptr<TriangleBvh>> surfaces;
  for (const Part& part : assembly.parts) surfaces.push_back(std::make_unique<TriangleBvh>(*part.mesh));
  const RunContext context;
  const SurfaceOf surface = [&](PartId id) -> const TriangleBvh& { return *surfaces[id]; };
  auto out = fastenings_of(assembly, fastener_shapes(assembly, context), surface, context);
  // Law: other parts' shapes are not needed.
  const auto all = fastenings_of(assembly, shapes_of(assembly, context), surface, context);
  EXPECT_EQ(out.size(), all.size());
  for (std::size_t i = 0; i < std::min(out.size(), all.size()); ++i) {
    EXPECT_EQ(out[i].screw, all[i].screw);
    EXPECT_EQ(out[i].clamps, all[i].clamps);
    EXPECT_EQ(out[i].into, all[i].into);
    EXPECT_EQ(out[i].only, all[i].only);
    EXPECT_EQ(out[i].nut, all[i].nut);
    EXPECT_EQ(out[i].faults.size(), all[i].faults.size());
  }
  return out;
}

/// By name of the screw, in words.
std::map<std::string, std::string> words_of(const Assembly& assembly) {
  std::map<std::string, std::string> out;
  for (const Fastening& f : found_in(assembly)) out[assembly.parts[f.screw].name] = fastening_text(assembly, f);
  return out;
}

std::vector<std::string> faults_of(const Assembly& assembly) {
  std::vector<std::string> out;
  for (const Fastening& f : found_in(assembly))
    for (const FasteningFault& fault : f.faults) out.push_back(fault_text(assembly, f, fault));
  return out;
}

TEST(Fastening, AScrewClampsALidToWhatItIsDrivenInto) {
  Rng rng(5);
  for (const char* unit : {"mm", "m", "inch"}) {
    Stack stack;
    stack.add_screw("screw", 10);
    stack.add_plate("lid", 3.4, -3, 0);
    stack.add_block("housing", 2.5, -3, -14);
    const Assembly assembly = stack.assembly(shapes::random_pose(rng, 30), rng.uniform(0.01, 2), unit);
    EXPECT_EQ(words_of(assembly)["screw"],
              "clamps 'lid' to 'housing'; driven into 'housing'; no other screw holds 'lid'")
        << unit;
    EXPECT_TRUE(faults_of(assembly).empty());
  }
}

TEST(Fastening, ABoltAndItsNutClampTwoPlates) {
  Stack stack;
  stack.add_screw("bolt", 12);
  stack.add_plate("washer", 3.2, -0.5, 0);
  stack.meshes.back() = shapes::tube(1.6, 3.5, -0.5, 0, 96);
  stack.add_plate("upper", 3.4, -4, -0.5);
  stack.add_plate("lower", 3.4, -8, -4);
  stack.add_nut("nut", -8);
  const Assembly assembly = stack.assembly();
  EXPECT_EQ(words_of(assembly)["bolt"],
            "clamps 'upper' and 'lower' together; driven into 'nut'; no other screw holds 'upper' or 'lower'");
  ASSERT_EQ(found_in(assembly).size(), 1u);
  EXPECT_EQ(found_in(assembly)[0].clamps, (std::vector<PartId>{1, 2, 3}));
  EXPECT_TRUE(faults_of(assembly).empty());
}

TEST(Fastening, OfTwoScrewsNoneHoldsThePlateAlone) {
  Stack stack;
  stack.add_screw("one", 10);
  stack.add_screw("two", 10, {30, 0, 0});
  const Mesh lid = shapes::tube(1.7, 12, -3, 0, 96), housing = shapes::tube(1.25, 12, -20, -3, 96);
  stack.add("lid", shapes::joined(lid, shapes::moved(lid, shapes::shift({30, 0, 0}))));
  stack.add("housing", shapes::joined(housing, shapes::moved(housing, shapes::shift({30, 0, 0}))));
  auto words = words_of(stack.assembly());
  EXPECT_EQ(words["one"], "clamps 'lid' to 'housing'; driven into 'housing'");
  EXPECT_EQ(words["two"], words["one"]);
}

TEST(Fastening, ASlotIsClampedAndAWallBesideTheScrewIsNot) {
  Stack stack;
  stack.add_screw("screw", 10);
  stack.add("forks",
            shapes::joined(shapes::box({-12, 1.7, -3}, {12, 12, 0}), shapes::box({-12, -12, -3}, {12, -1.7, 0})));
  stack.add_block("housing", 2.5, -3, -14);
  stack.add("wall", shapes::box({3, -12, 0.1}, {12, 12, 20}));
  EXPECT_EQ(words_of(stack.assembly())["screw"],
            "clamps 'forks' to 'housing'; driven into 'housing'; no other screw holds 'forks'");
}

TEST(Fastening, SaysNothingWhereTheShapeDoesNot) {
  Stack far;  // the lid is not under the head
  far.add_screw("screw", 16);
  far.add_plate("lid", 3.4, -7, -4);
  far.add_block("housing", 2.5, -9, -20);
  EXPECT_EQ(words_of(far.assembly())["screw"], "driven into 'housing'");
  Stack drawn;  // a through hole of the screw's own diameter may be a thread or may not
  drawn.add_screw("screw", 10);
  drawn.add_plate("plate", 3, -4, 0);
  EXPECT_EQ(words_of(drawn.assembly())["screw"], "");
  EXPECT_TRUE(faults_of(drawn.assembly()).empty());
  Stack loose;  // nothing is near
  loose.add_screw("screw", 10);
  loose.add_plate("plate", 8, -4, 0);
  EXPECT_EQ(words_of(loose.assembly())["screw"], "");
  EXPECT_TRUE(faults_of(loose.assembly()).empty());
}

TEST(Fastening, OfBoresWithoutPlayTheLastMayBeTheThread) {
  Stack stack;
  stack.add_screw("screw", 10);
  stack.add_plate("upper", 3, -4, 0);
  const PartId lower = stack.add_plate("lower", 3, -10, -4);
  const auto found = found_in(stack.assembly());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].into.empty());
  EXPECT_EQ(found[0].possible_thread, lower);
}

TEST(Fastening, ANutIsOnTheRodThatFillsItsHole) {
  Rng rng(3);
  for (const double hole : {2.5, 3.0, 3.2}) {
    Stack stack;
    const PartId rod =
        stack.add("rod", turned_solid({{0, circle(0)}, {0, circle(3)}, {40, circle(3)}, {40, circle(0)}}));
    const PartId nut = stack.add_nut("nut", 10, 5.5, hole);
    stack.add_nut("on nothing", 60, 5.5, hole);
    stack.add_nut("around a wire", 80, 5.5, hole);
    stack.add("wire", turned_solid({{70, circle(0)}, {70, circle(1)}, {90, circle(1)}, {90, circle(0)}}));
    stack.add_plate("wide", 3.4, -20, -17);
    const Assembly assembly = stack.assembly(shapes::random_pose(rng, 30));
    std::vector<std::unique_ptr<TriangleBvh>> surfaces;
    for (const Part& part : assembly.parts) surfaces.push_back(std::make_unique<TriangleBvh>(*part.mesh));
    const auto on = nuts_on_rods(assembly, shapes_of(assembly, RunContext{}), {},
                                 [&](PartId id) -> const TriangleBvh& { return *surfaces[id]; });
    ASSERT_EQ(on.size(), 1u) << hole;
    EXPECT_EQ(on[0].nut, nut);
    EXPECT_EQ(on[0].rod, rod);
  }
}

TEST(Fastening, FindsWhatIsWrong) {
  const auto faults = [](const std::function<void(Stack&)>& build) {
    Stack stack;
    build(stack);
    return faults_of(stack.assembly());
  };
  using Texts = std::vector<std::string>;
  EXPECT_EQ(faults([](Stack& s) {
              s.add_screw("bolt", 12);
              s.add_plate("upper", 3.4, -4, 0);
              s.add_plate("lower", 3.4, -8, -4);
            }),
            Texts{"'bolt' goes through all its parts with play, sticks out, and has no nut"});
  EXPECT_EQ(faults([](Stack& s) {
              s.add_screw("bolt", 12);
              s.add_plate("plate", 3.4, -8, 0);
              s.add_nut("nut", -8, 8, 4.2, 4);
            }),
            (Texts{"'bolt' (M3x12) and its nut 'nut' (M5) have different threads"}));
  EXPECT_EQ(faults([](Stack& s) {
              s.add_screw("bolt", 10);
              s.add_plate("plate", 3.4, -9, 0);
              s.add_nut("nut", -9);
            }),
            Texts{"'bolt' (M3x10) is too short for the thread of 'nut'"});
  EXPECT_EQ(faults([](Stack& s) {
              s.add_screw("screw", 10);
              s.add_plate("lid", 3.4, -9, 0);
              s.add_block("housing", 2.5, -9, -20);
            }),
            Texts{"'screw' (M3x10) is too short for the thread of 'housing'"});
  EXPECT_EQ(faults([](Stack& s) {
              s.add_screw("screw", 10);
              s.add_plate("lid", 3.4, -9, 0);
              s.add_nut("spacer bolt", -9, 5.5, 2.5, 11);
            }),
            Texts{"'screw' (M3x10) is too short for the thread of 'spacer bolt'"});
  EXPECT_EQ(faults([](Stack& s) {
              s.add_screw("screw", 8);
              s.add_plate("lid", 3.4, -9, 0);
              s.add_block("housing", 2.5, -9, -20);
            }),
            Texts{"'screw' (M3x8) is too short for the thread of 'housing'"});
  EXPECT_EQ(faults([](Stack& s) {
              s.add_screw("screw", 10);
              s.add_plate("lid", 3.4, -3, 0);
              s.add_block("housing", 2.5, -3, -10);
            }),
            Texts{"'screw' stands on the ground of its hole in 'housing'"});
}

}  // namespace
}  // namespace dismantle::fasteners
