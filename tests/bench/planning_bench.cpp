// Whole searches by guided on samples as users get them, with and without preparation, and the verifier alone.
#include <benchmark/benchmark.h>

#include "bench_models.h"
#include "dismantle/host/registry.h"
#include "dismantle/testing/path_checking.h"

namespace dismantle::bench {
namespace {

const Registry& registry() {
  static const std::unique_ptr<Registry> all = [] {
    auto r = std::make_unique<Registry>();
    r->scan();
    return r;
  }();
  return *all;
}

struct Task {
  Assembly assembly;
  Scene scene;
  std::vector<PartId> moving;
  std::unique_ptr<Verifier> verifier;
  std::shared_ptr<Simulator> simulator = registry().create<Simulator>("sdf_penalty");
  std::shared_ptr<PathPlanner> planner = registry().create<PathPlanner>("guided");
  std::shared_ptr<const PreparedAssembly> prepared;
  double verification = 0;  ///< seconds

  Task(const char* name, const char* part) : assembly(sample(name)) {
    moving = {part_called(assembly, part)};
    for (const auto& p : assembly.parts) (p.id == moving[0] ? scene.moving : scene.fixed).push_back({p.id, Pose{}});
    prepare();
  }
  void prepare() {
    RunContext context;
    prepared = simulator->prepare(assembly, 0.01, context);
    verifier = std::make_unique<Verifier>(assembly, VerifyOptions{});
  }
  PathResult plan() {
    RunContext context;
    const fake::RuleChecker checker([&](const Path& path) {
      const auto begin = Deadline::Clock::now();
      const fake::Ruling ruling = fake::ruling_of(verifier->check_motion(moving, scene.fixed, path));
      verification += std::chrono::duration<double>(Deadline::Clock::now() - begin).count();
      return ruling;
    });
    const PathQuery query{assembly, *simulator, *prepared, scene, {}, 0.01, checker};
    return plan_path(*planner, query, context);
  }
};

/// `prepare`: fields, contact points and the verifier's trees are part of it, on one thread.
void PathPlanning(benchmark::State& state, const char* name, const char* part, bool prepare) {
  Task task(name, part);
  PathResult result;
  for (auto _ : state) {
    if (prepare) task.prepare();
    result = task.plan();
    if (result.outcome() != Outcome::solved) state.SkipWithError("not solved");
  }
  for (const auto& [count, value] : result.stats.by_name()) state.counters[count] = value;
  state.counters["verification"] = benchmark::Counter(task.verification, benchmark::Counter::kAvgIterations);
}
BENCHMARK_CAPTURE(PathPlanning, peg_in_hole, "peg_in_hole", "peg", false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(PathPlanning, peg_in_hole_with_prepare, "peg_in_hole", "peg", true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(PathPlanning, l_slot, "l_slot", "slider", false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(PathPlanning, l_slot_with_prepare, "l_slot", "slider", true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(PathPlanning, inclined_washer, "inclined_washer", "washer", false)->Unit(benchmark::kMillisecond);

void VerifyPath(benchmark::State& state, const char* name, const char* part) {
  Task task(name, part);
  const PathResult result = task.plan();
  if (result.outcome() != Outcome::solved) state.SkipWithError("not solved");
  MotionCheck check;
  for (auto _ : state) {
    check = task.verifier->check_motion(task.moving, task.scene.fixed, result.path()->poses());
    benchmark::DoNotOptimize(check.valid);
  }
  std::size_t triangles = 0;
  for (const auto& p : task.assembly.parts) triangles += p.mesh->triangles.size();
  state.counters["instants"] = static_cast<double>(result.path()->poses().size());
  state.counters["triangles"] = static_cast<double>(triangles);
  state.counters["tests"] = static_cast<double>(check.tests);
}
BENCHMARK_CAPTURE(VerifyPath, peg_in_hole, "peg_in_hole", "peg")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(VerifyPath, l_slot, "l_slot", "slider")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(VerifyPath, inclined_washer, "inclined_washer", "washer")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace dismantle::bench
