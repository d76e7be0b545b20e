/// A small assembly with the simulator sdf_penalty and the verifier.
#pragma once

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "dismantle/executor.h"
#include "dismantle/host/registry.h"
#include "dismantle/path_planner.h"
#include "dismantle/testing/path_checking.h"
#include "solids.h"

namespace dismantle::path::test {

inline const Registry& registry() {
  static const std::unique_ptr<Registry> all = [] {
    auto r = std::make_unique<Registry>();
    r->scan();
    return r;
  }();
  return *all;
}

/// Parameters of the preset `guided` with `changes` and without some members. The keys of `changes` are parameter
/// names; those of a member are written as "tolerant_rrt.state_checks".
inline ParamSet guided(const std::map<std::string, ParamValue>& changes, const std::vector<std::string>& without = {}) {
  const RegisteredType& preset = registry().find(PluginKind::path_planner, "guided");
  ParamSet all;
  for (const ParamSpec& spec : preset.type.params) all[spec.name] = spec.fallback;
  auto& members = std::get<std::vector<PluginChoice>>(all.at("of"));
  for (const std::string& type : without) std::erase_if(members, [&](const auto& m) { return m.type == type; });
  for (const auto& [name, value] : changes) {
    const std::size_t dot = name.find('.');
    if (dot == std::string::npos) {
      all.at(name) = value;
      continue;
    }
    for (PluginChoice& m : members) {
      if (m.type != name.substr(0, dot)) continue;
      const std::string key = name.substr(dot + 1);
      (m.options.contains(key) ? m.options : m.parameters).at(key) = value;
    }
  }
  return all;
}

struct Table {
  Assembly assembly;
  std::shared_ptr<Simulator> simulator = registry().create<Simulator>("sdf_penalty");
  std::shared_ptr<const PreparedAssembly> prepared;
  Verifier verifier;
  std::atomic<std::size_t> checked = 0;  ///< number of paths
  std::shared_ptr<Executor> executor;    ///< its idle threads may help
  std::vector<PartId> any_of{};          ///< if not empty: parts move independently until one of these is out

  explicit Table(Assembly a, double tolerance = 0.01)
      : assembly(std::move(a)), verifier(assembly, {.max_penetration = tolerance}) {
    RunContext context;
    prepared = simulator->prepare(assembly, tolerance, context);
  }

  /// Plans the removal of part 0.
  PathResult plan(const std::string& planner, const ParamSet& given, std::uint64_t seed, std::uint64_t max_steps,
                  unsigned max_depth = 0) {
    return plan(planner, given, seed, {.max_depth = max_depth, .max_steps = max_steps}, {0});
  }

  /// Plans the removal of `moving` as one group. Parts in `left` are absent.
  PathResult plan(const std::string& planner, const ParamSet& given, std::uint64_t seed, const Budget& budget,
                  const std::vector<PartId>& moving, const std::vector<PartId>& left = {},
                  const SearchState* resume_from = nullptr) {
    Scene scene;
    for (const auto& part : assembly.parts) {
      if (std::find(left.begin(), left.end(), part.id) != left.end()) continue;
      (std::find(moving.begin(), moving.end(), part.id) != moving.end() ? scene.moving : scene.fixed)
          .push_back({part.id, Pose{}});
    }
    RunContext context;
    context.rng = Rng(seed);
    context.executor = executor;
    const fake::RuleChecker checker([&](const Path& path) {
      ++checked;
      const MotionCheck motion = verifier.check_motion(moving, scene.fixed, path);
      fake::Ruling ruling = fake::ruling_of(motion);
      if (motion.violation)
        for (std::size_t i = 0; i < moving.size(); ++i)
          ruling.poses.push_back(screw_interpolate(path[motion.violation->segment][i],
                                                   path[motion.violation->segment + 1][i], motion.violation->u));
      std::vector<PlacedPart> group = scene.moving;
      for (std::size_t i = 0; i < group.size(); ++i) group[i].pose = path.back()[i];
      ruling.accept = ruling.accept && is_out(group, scene.fixed);
      return ruling;
    });
    PathQuery query{assembly, *simulator, *prepared,  scene, budget, verifier.options().max_penetration,
                    checker,  {},         resume_from};
    query.goal.any_of = any_of;
    return plan_path(*registry().create<PathPlanner>(planner, given), query, context);
  }

 private:
  bool is_out(const std::vector<PlacedPart>& group, const std::vector<PlacedPart>& fixed) const {
    if (any_of.empty()) return verifier.apart(group, fixed);
    return std::any_of(any_of.begin(), any_of.end(), [&](PartId id) {
      std::vector<PlacedPart> alone, others = fixed;
      for (const PlacedPart& p : group) (p.part == id ? alone : others).push_back(p);
      return verifier.apart(alone, others);
    });
  }
};

}  // namespace dismantle::path::test
