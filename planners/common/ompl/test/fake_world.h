/// A world without meshes behind it: what is free is a function of the first body's pose.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "dismantle/path_planner.h"

namespace dismantle::sampling::fake {

class FakeWorld final : public World {
 public:
  FakeWorld(Cast cast, MotionSpace space, std::function<double(const Pose&)> depth,
            std::function<bool(const Pose&)> out)
      : cast_(std::move(cast)), space_(space), depth_(std::move(depth)), out_(std::move(out)) {}
  const Cast& cast() const override { return cast_; }
  MotionSpace space() const override { return space_; }
  State initial_state() const override {
    State s;
    for (const auto& m : cast_.moving) s.bodies.push_back({m.pose, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
    return s;
  }
  Eigen::Vector3d center(std::size_t) const override { return Eigen::Vector3d::Zero(); }
  double radius(std::size_t) const override { return 1; }
  double torque_arm(std::size_t) const override { return 1; }
  StepReport advance(State&, const Action&, double, Trace*) override { return {}; }
  double penetration(const State& s) override { return depth_(s.bodies[0].pose); }
  void contacts(const State&, std::vector<Contact>& out) override { out.clear(); }
  bool separated(const State& s) override { return out_(s.bodies[0].pose); }
  void learn(PartId, PartId, const Eigen::Vector3d&) override {}

 private:
  Cast cast_;
  MotionSpace space_;
  std::function<double(const Pose&)> depth_;
  std::function<bool(const Pose&)> out_;
};

struct FakeSimulator final : Simulator {
  std::function<double(const Pose&)> depth = [](const Pose&) { return 0.0; };
  std::function<bool(const Pose&)> out = [](const Pose&) { return false; };
  Capabilities capabilities() const noexcept override { return {.distance = true, .max_moving = 1}; }
  std::shared_ptr<const Prepared> prepare(const Assembly&, double, RunContext&) override {
    return std::make_shared<Prepared>();
  }
  std::unique_ptr<World> world(const Assembly&, const Prepared&, const Cast& cast, MotionSpace space) const override {
    return std::make_unique<FakeWorld>(cast, space, depth, out);
  }
};

}  // namespace dismantle::sampling::fake
