/// A simulator whose worlds are mazes for points: the answers are known without physics.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/host/registry.h"
#include "dismantle/path_planner.h"
#include "dismantle/testing/path_checking.h"

namespace dismantle::push::test {

using Eigen::Vector3d;

/// Free space, as a union of boxes. A point outside `exit` is separated.
struct Maze {
  std::vector<Aabb> free{};
  Aabb exit{Vector3d::Constant(-5), Vector3d::Constant(5)};
  std::vector<Aabb> free_after_learning{};  ///< after a contact sample; empty: as before
  double speed = 2.5;                       ///< units / s
  std::uint64_t steps_per_advance = 10;
  /// Couples points: gets the state after a step, and may move the points that have no wrench. False: no point moves.
  std::function<bool(State&, const Action&)> link{};
  std::map<PartId, Aabb> gates{};  ///< closed while this part is fixed
  bool hold_each_other = false;    ///< no point is ever apart from the others
  bool inside(const Vector3d& p, bool learned, const Scene& scene) const {
    if (gate_at(p, scene)) return false;
    for (const auto& box : learned && !free_after_learning.empty() ? free_after_learning : free)
      if (box.contains(p)) return true;
    return false;
  }
  std::optional<PartId> gate_at(const Vector3d& p, const Scene& scene) const {
    for (const auto& s : scene.fixed)
      if (const auto gate = gates.find(s.part); gate != gates.end() && gate->second.contains(p)) return s.part;
    return std::nullopt;
  }
};

/// Counts what the planner did in the worlds.
struct Notes {
  std::uint64_t worlds = 0, advances = 0, steps = 0, learned = 0;
  std::function<void()> on_advance;
};

class MazeWorld final : public World {
 public:
  MazeWorld(const Maze& maze, Notes& notes, const Scene& scene, MotionSpace space)
      : maze_(maze), notes_(notes), scene_(scene), space_(space) {}
  const Scene& scene() const override { return scene_; }
  MotionSpace space() const override { return space_; }
  State initial_state() const override {
    State s;
    for (const auto& m : scene_.moving) s.bodies.push_back({m.pose, Vector3d::Zero(), Vector3d::Zero()});
    return s;
  }
  Vector3d center(std::size_t) const override { return Vector3d::Zero(); }
  double radius(std::size_t) const override { return 0.1; }
  double torque_arm(std::size_t) const override { return 0.1; }

  StepReport advance(State& state, const Action& action, double duration, Trace* trace) override {
    ++notes_.advances;
    if (notes_.on_advance) notes_.on_advance();
    StepReport report;
    const State begin = state;
    for (std::uint64_t k = 0; k < maze_.steps_per_advance; ++k) {
      ++report.steps;
      ++notes_.steps;
      bool moved = false;
      const State was = state;
      for (std::size_t i = 0; i < state.bodies.size(); ++i) {
        const Vector3d& force = action.wrenches.at(i).force;
        if (force.norm() == 0) continue;
        const Vector3d displacement =
            maze_.speed * duration / static_cast<double>(maze_.steps_per_advance) * force.normalized();
        moved |= move(state.bodies[i].pose.t, displacement);
      }
      if (moved && maze_.link && !maze_.link(state, action)) {
        state = was;
        moved = false;
      }
      report.stalled = !moved;
      if (report.stalled) break;
      if (trace != nullptr) {
        trace->emplace_back();
        for (const auto& b : state.bodies) trace->back().push_back(b.pose);
      }
    }
    for (std::size_t i = 0; i < state.bodies.size(); ++i)
      report.travel = std::max(report.travel, (state.bodies[i].pose.t - begin.bodies[i].pose.t).norm());
    return report;
  }
  double penetration(const State& state) override {
    return std::all_of(state.bodies.begin(), state.bodies.end(),
                       [&](const auto& b) { return maze_.inside(b.pose.t, learned_, scene_); })
               ? 0
               : 1;
  }
  void contacts(const State& state, std::vector<Contact>& out) override {
    out.clear();
    for (std::size_t i = 0; i < state.bodies.size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
          const Vector3d& p = state.bodies[i].pose.t;
          const Vector3d beside = p + 0.03 * sign * Vector3d::Unit(axis);
          if (maze_.inside(beside, learned_, scene_)) continue;
          out.push_back({scene_.moving[i].part, maze_.gate_at(beside, scene_).value_or(scene_.fixed.front().part), p,
                         -sign * Vector3d::Unit(axis), 0.0});
        }
  }
  bool separated(const State& state) override {
    for (const auto& b : state.bodies)
      if (maze_.exit.contains(b.pose.t)) return false;
    return true;
  }
  bool body_separated(const State& state, std::size_t body) override {
    return !maze_.hold_each_other && !maze_.exit.contains(state.bodies[body].pose.t);
  }
  void add_contact_sample(PartId, PartId, const Vector3d&) override {
    ++notes_.learned;
    learned_ = true;
  }

 private:
  /// Moves the point as far as it is free, along a wall if the wall blocks it.
  bool move(Vector3d& p, const Vector3d& displacement) const {
    const Vector3d before = p;
    if (maze_.inside(p + displacement, learned_, scene_)) {
      p += displacement;
    } else {
      for (int axis = 0; axis < 3; ++axis)
        if (const Vector3d next = p + displacement[axis] * Vector3d::Unit(axis); maze_.inside(next, learned_, scene_))
          p = next;
    }
    return (p - before).norm() > 1e-3 * displacement.norm();  // a creeping point counts as stalled
  }

  const Maze& maze_;
  Notes& notes_;
  Scene scene_;
  MotionSpace space_;
  bool learned_ = false;
};

class MazeSimulator final : public Simulator {
 public:
  MazeSimulator(Maze maze, Notes& notes) : maze_(std::move(maze)), notes_(notes) {}
  Capabilities capabilities() const noexcept override { return has; }
  std::shared_ptr<const PreparedAssembly> prepare(const Assembly&, double, RunContext&) override {
    return std::make_shared<PreparedAssembly>();
  }
  std::unique_ptr<World> world(const Assembly&, const PreparedAssembly&, const Scene& scene,
                               MotionSpace space) const override {
    ++notes_.worlds;
    return std::make_unique<MazeWorld>(maze_, notes_, scene, space);
  }
  Capabilities has{.dynamics = true, .contacts = true, .distance = true, .max_moving = 4};

 private:
  Maze maze_;
  Notes& notes_;
};

inline const Registry& registry() {
  static const std::unique_ptr<Registry> all = [] {
    auto r = std::make_unique<Registry>();
    r->scan();
    return r;
  }();
  return *all;
}

inline Aabb tunnel(const Vector3d& from, const Vector3d& to, double half = 0.04) {
  Aabb box;
  box.extend(from);
  box.extend(to);
  box.inflate(half);
  return box;
}

/// One search in a maze, with its result and its candidate paths.
struct MazeRun {
  PathResult result;
  std::vector<Path> checked;
  Notes notes;
};

using fake::Ruling;
using Rule = std::function<Ruling(const Path&)>;
inline Ruling accept(const Path&) {
  Ruling ruling;
  ruling.accept = true;
  return ruling;
}

/// `moving` points start at the origin. Part 9 is fixed, and so are the `closed` gates. With `leaving`, the points move
/// independently. Resumes from `reached`.
inline void search(MazeRun& run, const Maze& maze, const ParamSet& given = {}, const Budget& effort = {},
                   const Rule& rule = accept, RunContext context = {}, std::size_t moving = 1,
                   Capabilities has = {true, true, true, 4}, const char* planner = "bfs",
                   const std::vector<PartId>& leaving = {}, const std::vector<PartId>& closed = {},
                   const SearchState* reached = nullptr) {
  MazeSimulator simulator(maze, run.notes);
  simulator.has = has;
  const Assembly assembly;
  const auto prepared = simulator.prepare(assembly, 0.01, context);
  Scene scene;
  for (std::size_t i = 0; i < moving; ++i) scene.moving.push_back({static_cast<PartId>(i), Pose{}});
  scene.fixed.push_back({9, Pose{}});
  for (const PartId gate : closed) scene.fixed.push_back({gate, Pose{}});
  const fake::RuleChecker checker([&](const Path& path) {
    run.checked.push_back(path);
    return rule(path);
  });
  const PathQuery query{assembly, simulator, *prepared, scene, effort, 0.01, checker, {leaving}, reached};
  run.result = plan_path(*registry().create<PathPlanner>(planner, given), query, context);
}

}  // namespace dismantle::push::test
