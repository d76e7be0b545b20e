/// A simulator that counts the queries of a path planner.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "dismantle/simulator.h"

namespace dismantle::contract {

using Eigen::Vector3d;

/// Simulated steps or, without dynamics, state checks.
struct Counted {
  std::uint64_t steps = 0;
  std::function<void()> on_step;
};

/// Wraps a real world and counts the queries.
class CountingWorld final : public World {
 public:
  CountingWorld(std::unique_ptr<World> inner, bool dynamics, Counted& counted)
      : inner_(std::move(inner)), dynamics_(dynamics), counted_(counted) {}
  const Scene& scene() const override { return inner_->scene(); }
  MotionSpace space() const override { return inner_->space(); }
  State initial_state() const override { return inner_->initial_state(); }
  Vector3d center(std::size_t body) const override { return inner_->center(body); }
  double radius(std::size_t body) const override { return inner_->radius(body); }
  double torque_arm(std::size_t body) const override { return inner_->torque_arm(body); }
  StepReport advance(State& state, const Action& action, double duration, Trace* trace) override {
    const StepReport report = inner_->advance(state, action, duration, trace);
    count(report.steps);
    return report;
  }
  double penetration(const State& state) override {
    if (!dynamics_) count(1);
    return inner_->penetration(state);
  }
  void project_to_clearance(State& state, double clearance) override { inner_->project_to_clearance(state, clearance); }
  void contacts(const State& state, std::vector<Contact>& out) override { inner_->contacts(state, out); }
  bool separated(const State& state) override { return inner_->separated(state); }
  bool body_separated(const State& state, std::size_t body) override { return inner_->body_separated(state, body); }
  void add_contact_sample(PartId part, PartId other, const Vector3d& point) override {
    inner_->add_contact_sample(part, other, point);
  }
  bool overlap_is_local() const override { return inner_->overlap_is_local(); }
  void allow_overlap_everywhere() override { inner_->allow_overlap_everywhere(); }

 private:
  void count(std::uint64_t n) {
    counted_.steps += n;
    if (counted_.on_step) counted_.on_step();
  }
  std::unique_ptr<World> inner_;
  bool dynamics_;
  Counted& counted_;
};

class CountingSimulator final : public Simulator {
 public:
  CountingSimulator(std::shared_ptr<Simulator> inner, Counted& counted)
      : has(inner->capabilities()), inner_(std::move(inner)), counted_(counted) {}
  Capabilities capabilities() const noexcept override { return has; }
  std::shared_ptr<const PreparedAssembly> prepare(const Assembly& assembly, double tolerance,
                                                  RunContext& context) override {
    return inner_->prepare(assembly, tolerance, context);
  }
  std::unique_ptr<World> world(const Assembly& assembly, const PreparedAssembly& prepared, const Scene& scene,
                               MotionSpace space) const override {
    return std::make_unique<CountingWorld>(inner_->world(assembly, prepared, scene, space), has.dynamics, counted_);
  }
  Capabilities has;

 private:
  std::shared_ptr<Simulator> inner_;
  Counted& counted_;
};

}  // namespace dismantle::contract
