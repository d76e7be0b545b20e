/// Small assemblies of boxes under a simulator that is made through the registry, as users get it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/host/registry.h"
#include "dismantle/simulator.h"

namespace dismantle::sdf::test {

using Eigen::Vector3d;

inline Mesh box(const Vector3d& lo, const Vector3d& hi) {
  Mesh m;
  for (int i = 0; i < 8; ++i)
    m.vertices.emplace_back((i & 1) != 0 ? hi.x() : lo.x(), (i & 2) != 0 ? hi.y() : lo.y(),
                            (i & 4) != 0 ? hi.z() : lo.z());
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

inline Mesh joined(Mesh a, const Mesh& b) {
  const auto offset = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return a;
}

/// A box with a closed room inside; `half`: of the room, `wall`: thickness all around.
inline Mesh closed_room(const Vector3d& half, double wall) {
  const Vector3d outer = half + Vector3d::Constant(wall);
  Mesh inner = box(-half, half);
  for (auto& t : inner.triangles) std::swap(t[1], t[2]);
  return joined(box(-outer, outer), inner);
}

inline Assembly assembly_of(std::vector<Mesh> meshes) {
  Assembly a;
  for (auto& mesh : meshes) {
    Part part;
    part.id = static_cast<PartId>(a.parts.size());
    part.name = "part" + std::to_string(part.id);
    part.mesh = part.surface = std::make_shared<const Mesh>(std::move(mesh));
    a.input_box.extend(part.mesh->box());
    a.parts.push_back(std::move(part));
  }
  return a;
}

inline const Registry& registry() {
  static const std::unique_ptr<Registry> all = [] {
    auto r = std::make_unique<Registry>();
    r->scan();
    return r;
  }();
  return *all;
}

struct Scene {
  Assembly assembly;
  std::shared_ptr<Simulator> simulator;
  std::shared_ptr<const Prepared> prepared;

  Scene(const std::string& id, std::vector<Mesh> meshes, const ParamSet& given,
        std::vector<InitialOverlap> overlaps = {})
      : assembly(assembly_of(std::move(meshes))) {
    assembly.overlaps = std::move(overlaps);
    simulator = registry().create<Simulator>(id, given);
    RunContext context;
    prepared = simulator->prepare(assembly, 0.01, context);
  }

  /// Parts that `moving` does not name stand still where they are assembled.
  std::unique_ptr<World> world(const std::vector<PartId>& moving, MotionSpace space = MotionSpace::translation) const {
    Cast cast;
    for (const PartId id : moving) cast.moving.push_back({id, Pose{}});
    for (const auto& part : assembly.parts)
      if (std::find(moving.begin(), moving.end(), part.id) == moving.end()) cast.still.push_back({part.id, Pose{}});
    return simulator->world(assembly, *prepared, cast, space);
  }
};

/// The same push for every moving part.
inline Action push(const Vector3d& force, const Vector3d& torque = Vector3d::Zero(), std::size_t bodies = 1) {
  return {std::vector<Wrench>(bodies, {force, torque})};
}

inline State at(const World& world, const Pose& pose) {
  State s = world.initial_state();
  s.bodies[0].pose = pose;
  return s;
}

inline Pose shift(double x, double y, double z) { return {Vector3d(x, y, z), Eigen::Quaterniond::Identity()}; }

/// Where the body's centre is now, less where it was assembled.
inline Vector3d way(const World& world, const State& state, std::size_t body = 0) {
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
