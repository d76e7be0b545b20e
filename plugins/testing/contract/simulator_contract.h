/// Fixture for the laws of simulators: worlds of each small assembly, with default parameters.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "small_assemblies.h"

namespace dismantle::contract {

class SimulatorContract : public testing::TestWithParam<std::string> {
 protected:
  struct Made {
    std::shared_ptr<Simulator> simulator;
    std::shared_ptr<const PreparedAssembly> prepared;
    const Small* small = nullptr;
    std::unique_ptr<World> world(const Scene& scene, MotionSpace space = MotionSpace::rigid) const {
      return simulator->world(small->assembly, *prepared, scene, space);
    }
    std::unique_ptr<World> world(MotionSpace space = MotionSpace::rigid) const { return world(small->scene(), space); }
  };
  static std::shared_ptr<Simulator> make() { return registry().create<Simulator>(GetParam()); }
  static Made made(const Small& small, unsigned threads = 1) {
    RunContext context;
    context.threads = threads;
    Made m{make(), nullptr, &small};
    m.prepared = m.simulator->prepare(small.assembly, 0.01, context);
    return m;
  }
  /// One simulator for each sample, prepared once for all tests.
  static const std::vector<Made>& all() {
    static std::map<std::string, std::vector<Made>> cache;
    auto& list = cache[GetParam()];
    if (list.empty())
      for (const auto& small : small_assemblies()) list.push_back(made(small));
    return list;
  }
  static State at(const World& world, const Pose& pose) {
    State s = world.initial_state();
    s.bodies[0].pose = pose;
    return s;
  }
  static Action push(const World& world, const Vector3d& force, const Vector3d& torque = Vector3d::Zero()) {
    return {std::vector<Wrench>(world.scene().moving.size(), {force, torque})};
  }
  static Pose random_pose(Rng& rng, MotionSpace space, double size) {
    const Vector3d t(rng.normal(), rng.normal(), rng.normal()), w(rng.normal(), rng.normal(), rng.normal());
    return {size * t, space == MotionSpace::rigid ? rotation_from_vector(0.5 * w) : Eigen::Quaterniond::Identity()};
  }
};

}  // namespace dismantle::contract
