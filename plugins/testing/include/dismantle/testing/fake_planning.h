/// Boxes, a simulator without physics and planners that follow a script: for tests of the oracle and the runner.
#pragma once

#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/engine/run.h"
#include "dismantle/testing/path_checking.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::fake {

/// An axis-aligned block, assembly units.
struct Box {
  Eigen::Vector3d lo, hi;
};

/// One mesh with a closed shell for each box.
inline Mesh boxes(const std::vector<Box>& list) {
  Mesh mesh;
  for (const auto& b : list) shapes::append(mesh, shapes::box(b.lo, b.hi));
  return mesh;
}

/// An assembly of these parts, without preparation.
inline Assembly assembly_of(const std::vector<std::pair<std::string, std::vector<Box>>>& parts) {
  Assembly a;
  a.source = "fake";
  Aabb box;
  for (const auto& [name, shells] : parts) {
    Part part;
    part.id = static_cast<PartId>(a.parts.size());
    part.name = name;
    part.file = name + ".obj";
    part.mesh = part.surface = std::make_shared<const Mesh>(boxes(shells));
    for (const auto& s : shells) part.volume += (s.hi - s.lo).prod();
    box.extend(part.mesh->box());
    a.parts.push_back(std::move(part));
  }
  a.input_box = box;
  return a;
}

/// A tube with a floor, open at the top (+z), and `n` stacked blocks in it, which leave only upwards, the highest
/// first. The tube is part 0; the blocks are 1 (lowest) to n.
inline Assembly tube_with_blocks(unsigned n) {
  const double height = 1.0 * n;
  std::vector<std::pair<std::string, std::vector<Box>>> parts{{"tube",
                                                               {{{-2, -2, -1}, {2, 2, -0.1}},
                                                                {{-2, -2, 0}, {-1, 2, height}},
                                                                {{1, -2, 0}, {2, 2, height}},
                                                                {{-0.95, -2, 0}, {0.95, -1, height}},
                                                                {{-0.95, 1, 0}, {0.95, 2, height}}}}};
  for (unsigned k = 0; k < n; ++k)
    parts.push_back({"block" + std::to_string(k + 1), {{{-0.8, -0.8, k + 0.1}, {0.8, 0.8, k + 0.9}}}});
  return assembly_of(parts);
}

/// A plate in a closed box: no part can be removed.
inline Assembly closed_box() {
  return assembly_of({{"box",
                       {{{-2, -2, -2}, {2, 2, -1.9}},
                        {{-2, -2, 1.9}, {2, 2, 2}},
                        {{-2, -2, -1.9}, {-1.9, 2, 1.9}},
                        {{1.9, -2, -1.9}, {2, 2, 1.9}},
                        {{-1.9, -2, -1.9}, {1.9, -1.9, 1.9}},
                        {{-1.9, 1.9, -1.9}, {1.9, 2, 1.9}}}},
                      {"plate", {{{-1, -1, -0.1}, {1, 1, 0.1}}}}});
}

/// Blocks side by side with gaps: they can leave in any order.
inline Assembly row(unsigned n) {
  std::vector<std::pair<std::string, std::vector<Box>>> parts;
  for (unsigned k = 0; k < n; ++k)
    parts.push_back({"block" + std::to_string(k), {{{2.0 * k, 0, 0}, {2.0 * k + 1, 1, 1}}}});
  return assembly_of(parts);
}

/// A simulator without physics, with the capabilities that a test sets.
class Physics final : public Simulator {
 public:
  Capabilities capabilities() const noexcept override { return has; }
  std::shared_ptr<const PreparedAssembly> prepare(const Assembly&, double, RunContext& context) override {
    if (on_prepare) on_prepare(context);
    return std::make_shared<PreparedAssembly>();
  }
  std::unique_ptr<World> world(const Assembly&, const PreparedAssembly&, const Scene&, MotionSpace) const override {
    throw std::logic_error("the fake simulator has no worlds");
  }
  Capabilities has{.dynamics = true, .contacts = true, .distance = true, .max_moving = 4};
  std::function<void(RunContext&)> on_prepare;
};

/// A straight path of two instants with displacement `displacement`.
inline Path straight(const Scene& scene, const Eigen::Vector3d& displacement) {
  Path path(2);
  for (const auto& p : scene.moving) {
    path[0].push_back(p.pose);
    path[1].push_back(Pose{p.pose.t + displacement, p.pose.q});
  }
  return path;
}

/// Pushes along the axes in random order, in two directions per unit of depth.
inline PathResult push(const PathQuery& query, RunContext& context) {
  std::vector<Eigen::Vector3d> displacements;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) displacements.push_back(sign * 30 * Eigen::Vector3d::Unit(axis));
  for (std::size_t n = displacements.size(); n > 1; --n)
    std::swap(displacements[n - 1], displacements[context.rng.below(n)]);
  const unsigned depth = query.budget.max_depth;
  const std::size_t allowed = depth == 0 || depth > 3 ? 6 : 2 * depth;
  PathResult result = PathResult::failure(allowed < 6 ? Outcome::depth_limit : Outcome::exhausted);
  for (std::size_t i = 0; i < allowed; ++i) {
    if (context.should_stop()) {
      result.fail(Outcome::cancelled);
      return result;
    }
    PathCheck check = query.checker.check(straight(query.scene, displacements[i]));
    result.stats.extra["checked"] += 1;
    if (check.accepted()) {
      result.solve(std::move(*check.verified), 1);
      return result;
    }
    if (check.has_witness)
      result.blocked_by.push_back(check.part == query.scene.moving[0].part ? check.other : check.part);
  }
  return result;
}

/// Checks `path`; solved if it is accepted.
inline PathResult shown(const PathQuery& query, const Path& path) {
  PathResult result;
  PathCheck check = query.checker.check(path);
  if (check.accepted())
    result.solve(std::move(*check.verified), 1);
  else
    result.fail(Outcome::exhausted, check.reason);
  return result;
}

/// Claims that `path` was accepted, although by another checker than that of the query.
inline PathResult forged(const Path& path) {
  PathResult result;
  result.solve(accept_all().verified(path), 1);
  return result;
}

/// The function that replaces a search.
using Script = std::function<PathResult(const PathQuery&, RunContext&)>;

/// A path planner that is one function.
class Scripted final : public FunctionPathPlanner {
 public:
  explicit Scripted(Script script) : script_(std::move(script)) {}
  PathPlannerTraits traits() const noexcept override {
    return {.needs = {.dynamics = true}, .simultaneous_motion = true, .resumable = true};
  }
  PathResult plan(const PathQuery& query, RunContext& context) override { return script_(query, context); }

 private:
  Script script_;
};

/// A set-up of the fake simulator, a scripted path planner and a sequence planner.
inline PlanningSetup setup(Script script, std::shared_ptr<SequencePlanner> sequence = nullptr) {
  PlanningSetup i;
  i.simulator = std::make_shared<Physics>();
  i.path_planner = [script] { return std::make_shared<Scripted>(script); };
  i.sequence_planner = std::move(sequence);
  i.path_planner_id = "scripted";
  return i;
}

/// A result with this outcome, as a planner returns it.
inline PathResult outcome(Outcome o, std::string message = {}) {
  if (o != Outcome::start_is_goal) return PathResult::failure(o, std::move(message));
  PathResult result;
  result.start_is_goal();
  return result;
}

/// `part` leaves, all others are fixed.
inline Attempt leave(const Assembly& assembly, PartId part, unsigned max_depth = 0) {
  Attempt a;
  a.max_depth = max_depth;
  a.moving.push_back({part, Pose{}});
  for (const auto& p : assembly.parts)
    if (p.id != part) a.fixed.push_back({p.id, Pose{}});
  return a;
}

}  // namespace dismantle::fake
