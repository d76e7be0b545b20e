// Directions of operations.
#include "dismantle/step_check.h"

#include <gtest/gtest.h>

#include <memory>

#include "dismantle/run_context.h"

namespace dismantle {
namespace {

using Eigen::Vector3d;

Vector3d any_vector(Rng& rng) { return {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)}; }

/// A box anywhere, so that its centre is beside the axis of the motion.
Assembly one_box(Rng& rng) {
  Mesh mesh;
  const Vector3d from = 3 * any_vector(rng);
  mesh.vertices = {from, from + Vector3d(1, 0, 0), from + Vector3d(0, 2, 0), from + Vector3d(0, 0, 3)};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  Assembly assembly;
  assembly.parts.emplace_back();
  assembly.parts[0].mesh = std::make_shared<Mesh>(mesh);
  return assembly;
}

/// Removal: a turn by `angle` and an advance along the axis in each of ten steps, from any place.
Trace screw(Rng& rng, const Vector3d& axis, double angle, double advance) {
  const Vector3d on_axis = any_vector(rng);
  const Pose start{any_vector(rng), rotation_from_vector(any_vector(rng))};
  Trace path;
  for (int k = 0; k <= 10; ++k) {
    const Eigen::Quaterniond turn = rotation_from_vector(k * angle * axis);
    path.push_back({Pose{on_axis - turn * on_axis + k * advance * axis, turn} * start});
  }
  return path;
}

Vector3d direction_of(const Assembly& assembly, const Trace& removal) {
  return Operation(assembly, {{0, removal.front().front()}}, {}, removal, Vector3d::UnitZ()).question().direction;
}

// Law: what is screwed in goes along the axis, wherever its centre is, and against the removal.
TEST(Operation, TheDirectionOfAScrewIsItsAxis) {
  Rng rng(53);
  for (int trial = 0; trial < 200; ++trial) {
    const Assembly assembly = one_box(rng);
    const Vector3d axis = any_vector(rng).normalized();
    const double advance = rng.below(2) == 0 ? 0.2 : -0.2;
    const Vector3d found = direction_of(assembly, screw(rng, axis, rng.uniform(-0.2, 0.2), advance));
    EXPECT_NEAR((found + (advance > 0 ? axis : Vector3d(-axis))).norm(), 0, 1e-9) << trial;
  }
}

// Law: without an advance along the axis, and without a turn, it is the way of the centre.
TEST(Operation, TheDirectionOfAHingeAndOfAPushIsTheWayOfTheCentre) {
  Rng rng(54);
  for (int trial = 0; trial < 200; ++trial) {
    const Assembly assembly = one_box(rng);
    const bool push = trial % 2 == 0;
    const Trace path = screw(rng, any_vector(rng).normalized(), push ? 0 : 0.1, push ? 0.1 : 1e-6);
    const Vector3d centre = assembly.parts[0].mesh->box().center();
    const Vector3d way = path[0].front() * centre - path[1].front() * centre;
    EXPECT_NEAR((direction_of(assembly, path) - way.normalized()).norm(), 0, 1e-9) << trial;
  }
}

}  // namespace
}  // namespace dismantle
