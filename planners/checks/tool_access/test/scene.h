/// Scenes of fasteners for tests, in millimetres.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/testing/trials.h"
#include "solids.h"
#include "tool_access.h"

namespace dismantle::checks::test {

namespace solids = fasteners::test;
using Eigen::Vector3d;

/// Parts in millimetres, then all of them at a pose, in a unit, at the scale of an assembly.
struct Scene : solids::NamedMeshes {
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
inline Mesh screw() { return solids::screw({3, 10, 5.5, 3, {}, solids::polygon(6, 2.5), 1.5}); }
/// A plate with a threaded hole, under the head.
inline Mesh plate() {
  return solids::turned_solid(
      {{-12, solids::polygon(4, 60)}, {0, solids::polygon(4, 60)}, {0, solids::circle(3)}, {-12, solids::circle(3)}},
      144);
}
/// A wall around a well of this radius above the plate.
inline Mesh wall(double radius, double high) {
  return solids::turned_solid({{0.01, solids::circle(60)},
                               {high, solids::circle(60)},
                               {high, solids::circle(2 * radius)},
                               {0.01, solids::circle(2 * radius)}},
                              96);
}

/// Four screws s1 to s4 at the corners of a square, a lid that they clamp, and the base that they are driven into.
struct FourScrews {
  explicit FourScrews(Scene& scene) {
    Mesh whole_lid, whole_base;
    for (const Vector3d& at : {Vector3d(0, 0, 0), Vector3d(30, 0, 0), Vector3d(30, 30, 0), Vector3d(0, 30, 0)}) {
      screws.push_back(scene.add("s" + std::to_string(screws.size() + 1), screw(), at - Vector3d(0, 0, 10)));
      const auto place = [&](const Mesh& tube) { return shapes::moved(tube, shapes::shift(at)); };
      whole_lid = shapes::joined(whole_lid, place(shapes::tube(1.7, 14, -3, 0, 64)));
      whole_base = shapes::joined(whole_base, place(shapes::tube(1.25, 14, -20, -3, 64)));
    }
    lid = scene.add("lid", whole_lid);
    base = scene.add("base", whole_base);
  }
  std::vector<PartId> screws;
  PartId lid = 0, base = 0;
};

inline StepVerdict judge(const ToolAccess& check, const Assembly& assembly, const std::vector<PartId>& moving,
                         const std::vector<PartId>& present, const Vector3d& direction,
                         const StepQuestion* previous = nullptr) {
  std::vector<PlacedPart> in, there;
  for (const PartId p : moving) in.push_back({p, Pose{}});
  for (const PartId p : present) there.push_back({p, Pose{}});
  StepQuestion question{assembly, in, there, direction};
  question.previous = previous;
  return check.judge(question, RunContext{});
}

/// Calls law(assembly, down), or law(assembly, down, pose), for the scene at random poses and scales in all units.
template <class Law>
void everywhere(const Scene& scene, const Law& law) {
  Rng rng(11);
  for (int trial = 0; trial < testing_support::trials(1, 10); ++trial)
    for (const char* unit : {"mm", "m", "inch"}) {
      const Pose pose = shapes::random_pose(rng, 30);
      const Assembly assembly = scene.assembly(pose, rng.uniform(0.01, 2), unit);
      const Vector3d down = pose.q * -Vector3d::UnitZ();
      if constexpr (std::is_invocable_v<Law, const Assembly&, const Vector3d&, const Pose&>)
        law(assembly, down, pose);
      else
        law(assembly, down);
    }
}

inline nlohmann::json data_of(const StepVerdict& v, const std::string& kind) {
  EXPECT_EQ(v.notes.size(), 1u);
  if (v.notes.size() != 1) return nlohmann::json::object();
  EXPECT_EQ(v.notes[0].kind, "tool_access." + kind) << v.notes[0].text;
  return nlohmann::json::parse(v.notes[0].data);
}

}  // namespace dismantle::checks::test
