// A time step of a part with 10 000 contact points of which 200 touch, sliding on a plate of 20 000 triangles.
#include <benchmark/benchmark.h>

#include "bench_models.h"
#include "world.h"

namespace dismantle::bench {
namespace {

using sdf_penalty::Dynamics;

/// A slab of 116 x 57 nodes a side, each a corner of its own height, so that all but those in folds, 10 000 in all, are
/// contact points; 200 of the lower ones are feet at z = 0. `scattered`: all over the slab, else every other node of
/// one patch of 20 x 20.
Mesh brush(bool scattered) {
  Rng rng(3);
  const auto low = [&](int i, int j) {
    const double up = rng.uniform(0.1, 0.2);
    const int x = i - 8, y = j - 4;  // the feet lie around the middle
    const bool foot = scattered ? x >= 0 && x < 100 && y >= 0 && y < 50 && x % 5 == 2 && y % 5 == 2
                                : x >= 40 && x < 60 && y >= 15 && y < 35 && (x + y) % 2 == 0;
    return foot ? 0.0 : up;
  };
  const auto high = [&](int, int) { return rng.uniform(1.0, 1.1); };
  return slab(116, 57, 0.06, 0.06, low, high);
}

struct Rig {
  Assembly assembly;
  sdf::PreparedShapes shapes;
  std::unique_ptr<sdf_penalty::PenaltyWorld> world;

  Rig(bool scattered, Dynamics dynamics, MotionSpace space) {
    Rng rng(4);
    const auto flat = [](int, int) { return 0.0; };
    const auto below = [](int, int) { return -0.5; };
    assembly = assembly_of({brush(scattered), slab(101, 101, 0.12, 0.12, below, flat)});
    sdf::ShapeOptions options;
    options.points.spacing = 10;  // the corners are enough
    options.grid.max_nodes = 4'000'000;
    RunContext context;
    context.threads = 2;
    shapes.placed = sdf::build_shapes(assembly, options, context);
    sdf_penalty::Parameters parameters;
    parameters.dynamics = dynamics;
    world = std::make_unique<sdf_penalty::PenaltyWorld>(shapes, Scene{{{0, Pose{}}}, {{1, Pose{}}}}, space, parameters);
  }
};

/// Presses down and slides to and fro, so that every step moves and the same feet stay in contact.
void ContactStep(benchmark::State& state, Dynamics dynamics) {
  const bool scattered = state.range(0) != 0;
  const MotionSpace space = state.range(1) != 0 ? MotionSpace::rigid : MotionSpace::translation;
  Rig rig(scattered, dynamics, space);
  State s = rig.world->initial_state();
  const double duration = 0.1;
  Action action{{Wrench{}}};
  std::uint64_t steps = 0, advances = 0;
  double simulated = 0;
  const auto advance = [&] {
    action.wrenches[0].force = Vector3d(advances++ % 10 < 5 ? 80 : -80, 20, -60);
    if (advances % 20 >= 10) action.wrenches[0].force.y() = -20;
    const StepReport report = rig.world->advance(s, action, duration, nullptr);
    for (auto& b : s.bodies) b.velocity.x() = b.velocity.y() = 0;
    steps += report.steps;
    simulated += duration;
  };
  advance();
  steps = 0;
  simulated = 0;
  for (auto _ : state) advance();
  std::vector<Contact> contacts;
  rig.world->contacts(s, contacts);
  std::int64_t touching = 0;
  for (const auto& c : contacts) touching += c.depth > 0 ? 1 : 0;
  state.counters["points"] = static_cast<double>(rig.shapes.placed[0].shape->points.points.size());
  state.counters["listed"] = static_cast<double>(contacts.size());
  state.counters["touching"] = static_cast<double>(touching);
  state.counters["per_step"] =
      benchmark::Counter(static_cast<double>(steps), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["steps/0.1s"] = static_cast<double>(steps) * duration / simulated;
  state.counters["per_ms_simulated"] =
      benchmark::Counter(simulated * 1e3, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(ContactStep, quasi_static, Dynamics::quasi_static)
    ->ArgNames({"scattered", "rigid"})
    ->ArgsProduct({{0, 1}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(ContactStep, unit_mass, Dynamics::unit_mass)
    ->ArgNames({"scattered", "rigid"})
    ->ArgsProduct({{0, 1}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

/// What it costs when nothing touches.
void FreeStep(benchmark::State& state) {
  Rig rig(true, Dynamics::unit_mass, MotionSpace::rigid);
  State s = rig.world->initial_state();
  s.bodies[0].pose.t.z() = 3;
  Action action{{Wrench{}}};
  std::uint64_t steps = 0;
  bool forth = true;
  for (auto _ : state) {
    action.wrenches[0].force = Vector3d(forth ? 50 : -50, 0, 0);
    forth = !forth;
    s.bodies[0].velocity.setZero();
    steps += rig.world->advance(s, action, 0.1, nullptr).steps;
  }
  state.counters["per_step"] =
      benchmark::Counter(static_cast<double>(steps), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(FreeStep)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace dismantle::bench
