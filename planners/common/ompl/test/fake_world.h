/// A world without meshes. A function of the first body's pose decides whether a state is free.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "dismantle/path_planner.h"

namespace dismantle::fake {

class FakeWorld final : public World {
 public:
  FakeWorld(Scene scene, MotionSpace space, std::function<double(const Pose&)> depth,
            std::function<bool(const Pose&)> out)
      : scene_(std::move(scene)), space_(space), depth_(std::move(depth)), out_(std::move(out)) {}
  const Scene& scene() const override { return scene_; }
  MotionSpace space() const override { return space_; }
  State initial_state() const override {
    State s;
    for (const auto& m : scene_.moving) s.bodies.push_back({m.pose, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
    return s;
  }
  Eigen::Vector3d center(std::size_t) const override { return Eigen::Vector3d::Zero(); }
  double radius(std::size_t) const override { return 1; }
  double torque_arm(std::size_t) const override { return 1; }
  StepReport advance(State&, const Action&, double, Trace*) override { return {}; }
  double penetration(const State& s) override { return depth_(s.bodies[0].pose); }
  void contacts(const State&, std::vector<Contact>& out) override { out.clear(); }
  bool separated(const State& s) override { return out_(s.bodies[0].pose); }
  void add_contact_sample(PartId, PartId, const Eigen::Vector3d&) override {}

 private:
  Scene scene_;
  MotionSpace space_;
  std::function<double(const Pose&)> depth_;
  std::function<bool(const Pose&)> out_;
};

struct FakeSimulator final : Simulator {
  std::function<double(const Pose&)> depth = [](const Pose&) { return 0.0; };
  std::function<bool(const Pose&)> out = [](const Pose&) { return false; };
  Capabilities capabilities() const noexcept override { return {.distance = true, .max_moving = 1}; }
  std::shared_ptr<const PreparedAssembly> prepare(const Assembly&, double, RunContext&) override {
    return std::make_shared<PreparedAssembly>();
  }
  std::unique_ptr<World> world(const Assembly&, const PreparedAssembly&, const Scene& scene,
                               MotionSpace space) const override {
    return std::make_unique<FakeWorld>(scene, space, depth, out);
  }
};

}  // namespace dismantle::fake
