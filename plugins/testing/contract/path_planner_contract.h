/// Fixture for the laws of path planners. A planner runs with the first simulator that has the needed capabilities,
/// with default parameters.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "counting_simulator.h"
#include "small_assemblies.h"

namespace dismantle::contract {

inline bool covers(const Capabilities& has, const Capabilities& needs) {
  return (has.dynamics || !needs.dynamics) && (has.contacts || !needs.contacts) && (has.distance || !needs.distance);
}

inline bool same(const Path& a, const Path& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k].size() != b[k].size()) return false;
    for (std::size_t i = 0; i < a[k].size(); ++i)
      if (!bitwise(a[k][i], b[k][i])) return false;
  }
  return true;
}

/// The poses of the path found; empty without one.
inline Path poses_of(const PathResult& result) { return result.path() ? result.path()->poses() : Path{}; }

/// A planner polls cancellation and budget at least once in this many steps (see PathPlanner).
constexpr std::uint64_t kLook = 100;
/// Enough for any of the small assemblies.
constexpr std::uint64_t kPlenty = 10'000;

class PathPlannerContract : public testing::TestWithParam<std::string> {
 protected:
  struct Ready {
    std::shared_ptr<Simulator> simulator;
    std::vector<std::shared_ptr<const PreparedAssembly>> prepared;  ///< in the order of small_assemblies()
  };
  struct Run {
    PathResult result;
    std::vector<std::pair<Path, bool>> checked;  ///< path, and whether it was accepted
    Counted counted;
    std::string output;
  };
  using Rule = std::function<fake::Ruling(const Path&)>;

  static std::shared_ptr<PathPlanner> make() { return registry().create<PathPlanner>(GetParam()); }
  /// The simulator and its prepared assemblies, once for all tests; null when no simulator fits.
  static const Ready* ready() {
    static std::map<std::string, Ready> cache;
    const Capabilities needs = make()->traits().needs;
    auto candidates = registry().types(PluginKind::simulator);  // own simulators first: third-party ids contain a dot
    std::stable_partition(candidates.begin(), candidates.end(),
                          [](const RegisteredType* t) { return t->type.id.find('.') == std::string::npos; });
    for (const RegisteredType* candidate : candidates) {
      const std::string& id = candidate->type.id;
      if (cache.contains(id)) {
        if (covers(cache.at(id).simulator->capabilities(), needs)) return &cache.at(id);
        continue;
      }
      auto simulator = registry().create<Simulator>(id);
      if (!covers(simulator->capabilities(), needs)) continue;
      Ready& r = cache[id];
      r.simulator = simulator;
      for (const auto& small : small_assemblies()) {
        RunContext context;
        r.prepared.push_back(simulator->prepare(small.assembly, kTolerance, context));
      }
      return &r;
    }
    return nullptr;
  }

  static fake::Ruling verify(const Small& small, const Scene& scene, const Path& path) {
    std::vector<PartId> moving;
    std::vector<PlacedPart> group = scene.moving;
    for (std::size_t i = 0; i < group.size(); ++i) {
      moving.push_back(group[i].part);
      group[i].pose = path.back()[i];
    }
    const MotionCheck check = small.verifier->check_motion(moving, scene.fixed, path);
    fake::Ruling v = fake::ruling_of(check);
    v.accept = v.accept && small.verifier->apart(group, scene.fixed);
    if (v.has_witness) v.reason = "it cuts";
    return v;
  }

  /// Runs one search. Without a rule the verifier checks the paths.
  static void plan(Run& run, std::size_t which, const Budget& effort = {.max_steps = kPlenty}, RunContext context = {},
                   const Rule& rule = {}, const Scene* scene = nullptr, PathPlanner* planner = nullptr,
                   const SearchState* resume_from = nullptr) {
    const Small& small = small_assemblies()[which];
    CountingSimulator simulator(ready()->simulator, run.counted);
    const Scene chosen = scene != nullptr ? *scene : small.scene();
    const fake::RuleChecker checker([&](const Path& path) {
      const fake::Ruling ruling = rule ? rule(path) : verify(small, chosen, path);
      run.checked.emplace_back(path, ruling.accept);
      return ruling;
    });
    const PathQuery query{small.assembly, simulator, *ready()->prepared[which], chosen, effort, kTolerance, checker, {},
                          resume_from};
    const auto own = make();
    testing::internal::CaptureStdout();
    run.result = plan_path(planner != nullptr ? *planner : *own, query, context);
    run.output = testing::internal::GetCapturedStdout();
    expect_lawful(run, small, chosen, effort);
  }

  /// Checks the laws of every search, independent of its outcome.
  static void expect_lawful(const Run& run, const Small& small, const Scene& scene, const Budget& effort) {
    SCOPED_TRACE(small.name);
    const PathResult& r = run.result;
    EXPECT_TRUE(run.output.empty()) << "planners never print: " << run.output;
    EXPECT_NE(r.outcome(), Outcome::crashed);
    for (const PartId id : r.blocked_by)
      EXPECT_TRUE(std::any_of(scene.fixed.begin(), scene.fixed.end(), [id](const auto& p) { return p.part == id; }))
          << "part " << id << " does not stay fixed";
    for (std::size_t i = 0; i < r.blocked_by.size(); ++i)
      EXPECT_EQ(std::count(r.blocked_by.begin(), r.blocked_by.end(), r.blocked_by[i]), 1);
    if (!r.best_pose.empty()) {
      EXPECT_EQ(r.best_pose.size(), scene.moving.size());
    }
    if (effort.max_steps > 0) {
      // Steps between two polls are allowed, and simplifying a path that was found within the budget.
      const std::uint64_t simplify = 300;
      EXPECT_LE(run.counted.steps, effort.max_steps + kLook + (run.checked.empty() ? 0 : simplify));
    }
    for (const auto& [path, accepted] : run.checked) {
      ASSERT_GE(path.size(), 2u);
      for (const auto& instant : path) {
        ASSERT_EQ(instant.size(), scene.moving.size());
        for (const auto& pose : instant) {
          ASSERT_TRUE(pose.t.allFinite());
          ASSERT_NEAR(pose.q.norm(), 1, 1e-9);
        }
      }
      for (std::size_t i = 0; i < scene.moving.size(); ++i)
        EXPECT_TRUE(bitwise(path.front()[i], scene.moving[i].pose)) << "starts where the parts are";
    }
    if (r.outcome() == Outcome::solved) {
      ASSERT_FALSE(run.checked.empty()) << "no path without a check";
      EXPECT_TRUE(std::any_of(run.checked.begin(), run.checked.end(), [&](const auto& j) {
        return j.second && same(j.first, r.path()->poses());
      })) << "just this path was accepted";
      const auto world = ready()->simulator->world(
          small.assembly, *ready()->prepared[static_cast<std::size_t>(&small - small_assemblies().data())], scene,
          MotionSpace::rigid);
      State end = world->initial_state();
      for (std::size_t i = 0; i < end.bodies.size(); ++i) end.bodies[i].pose = r.path()->poses().back()[i];
      EXPECT_TRUE(world->separated(end));
    } else if (r.outcome() != Outcome::start_is_goal) {
      EXPECT_FALSE(r.path()) << to_string(r.outcome());
    }
  }

  void SetUp() override {
    if (ready() == nullptr) GTEST_SKIP() << "no simulator here has what this planner needs";
  }
};

}  // namespace dismantle::contract
