/// Small assemblies of boxes in a simulator created through the registry, as for users.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/host/registry.h"
#include "dismantle/simulator.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::sdf::test {

using Eigen::Vector3d;
using shapes::box, shapes::joined, shapes::assembly_of;

/// A box with a closed room inside; `half`: of the room, `wall`: thickness all around.
inline Mesh closed_room(const Vector3d& half, double wall) {
  const Vector3d outer = half + Vector3d::Constant(wall);
  return shapes::closed_box(-outer, outer, wall);
}

inline const Registry& registry() {
  static const std::unique_ptr<Registry> all = [] {
    auto r = std::make_unique<Registry>();
    r->scan();
    return r;
  }();
  return *all;
}

struct TestScene {
  Assembly assembly;
  std::shared_ptr<Simulator> simulator;
  std::shared_ptr<const PreparedAssembly> prepared;

  TestScene(const std::string& id, std::vector<Mesh> meshes, const ParamSet& given,
            std::vector<InitialOverlap> overlaps = {})
      : assembly(assembly_of(std::move(meshes))) {
    assembly.overlaps = std::move(overlaps);
    simulator = registry().create<Simulator>(id, given);
    RunContext context;
    prepared = simulator->prepare(assembly, 0.01, context);
  }

  /// Parts not in `moving` are fixed in assembled position.
  std::unique_ptr<World> world(const std::vector<PartId>& moving, MotionSpace space = MotionSpace::translation) const {
    Scene scene;
    for (const PartId id : moving) scene.moving.push_back({id, Pose{}});
    for (const auto& part : assembly.parts)
      if (std::find(moving.begin(), moving.end(), part.id) == moving.end()) scene.fixed.push_back({part.id, Pose{}});
    return simulator->world(assembly, *prepared, scene, space);
  }
};

/// The same wrench for every moving part.
inline Action push(const Vector3d& force, const Vector3d& torque = Vector3d::Zero(), std::size_t bodies = 1) {
  return {std::vector<Wrench>(bodies, {force, torque})};
}

inline State at(const World& world, const Pose& pose) {
  State s = world.initial_state();
  s.bodies[0].pose = pose;
  return s;
}

inline Pose shift(double x, double y, double z) { return {Vector3d(x, y, z), Eigen::Quaterniond::Identity()}; }

/// Displacement of the body's centre from its assembled position.
inline Vector3d displacement(const World& world, const State& state, std::size_t body = 0) {
  return state.bodies[body].pose * world.center(body) - world.center(body);
}

/// Largest |a - b| over all coordinates of all poses.
inline double apart(const State& a, const State& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    largest = std::max(largest, (a.bodies[i].pose.t - b.bodies[i].pose.t).cwiseAbs().maxCoeff());
    largest = std::max(largest, (a.bodies[i].pose.q.coeffs() - b.bodies[i].pose.q.coeffs()).cwiseAbs().maxCoeff());
  }
  return largest;
}

}  // namespace dismantle::sdf::test
