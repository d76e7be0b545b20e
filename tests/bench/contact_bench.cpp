// A time step of a part of which a share of the contact points touches, sliding on a plate of many triangles.
#include <benchmark/benchmark.h>

#include "bench_models.h"
#include "world.h"

namespace dismantle::bench {
namespace {

using sdf_penalty::Dynamics;

/// A slab of nx x ny nodes a side, each a corner of its own height, so that all but those in folds are contact points;
/// the lower ones that `is_foot(i, j)` names are feet at z = 0.
template <class IsFoot>
Mesh brush(int nx, int ny, const IsFoot& is_foot) {
  Rng rng(3);
  const auto low = [&](int i, int j) {
    const double up = rng.uniform(0.1, 0.2);
    return is_foot(i, j) ? 0.0 : up;
  };
  const auto high = [&](int, int) { return rng.uniform(1.0, 1.1); };
  return slab(nx, ny, 0.06, 0.06, low, high);
}

/// 10 000 contact points and 200 feet. `scattered`: all over the slab, else every other node of one patch of 20 x 20.
Mesh brush_of_200(bool scattered) {
  return brush(116, 57, [scattered](int i, int j) {
    const int x = i - 8, y = j - 4;  // the feet lie around the middle
    return scattered ? x >= 0 && x < 100 && y >= 0 && y < 50 && x % 5 == 2 && y % 5 == 2
                     : x >= 40 && x < 60 && y >= 15 && y < 35 && (x + y) % 2 == 0;
  });
}

/// Ten times as many contact points as feet, which lie all over the slab.
Mesh brush_of(int feet) {
  const int columns = static_cast<int>(std::ceil(std::sqrt(10.0 * feet))), rows = (10 * feet * 2 / 3) / columns;
  const std::int64_t inner = static_cast<std::int64_t>(columns - 2) * (rows - 2);
  return brush(columns, rows, [=](int i, int j) {
    if (i == 0 || j == 0 || i == columns - 1 || j == rows - 1) return false;
    const std::int64_t at = static_cast<std::int64_t>(i - 1) * (rows - 2) + j - 1;
    return (at + 1) * feet / inner > at * feet / inner;
  });
}

struct Rig {
  Assembly assembly;
  sdf::PreparedShapes shapes;
  std::unique_ptr<sdf_penalty::PenaltyWorld> world;

  Rig(Mesh part, Dynamics dynamics, MotionSpace space) {
    const Vector3d size = part.box().size();
    const int nx = static_cast<int>(size.x() / 0.12) + 10, ny = static_cast<int>(size.y() / 0.12) + 10;
    const auto flat = [](int, int) { return 0.0; };
    const auto below = [](int, int) { return -0.5; };
    assembly = assembly_of({std::move(part), slab(nx, ny, 0.12, 0.12, below, flat)});
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
void slide(benchmark::State& state, Rig& rig) {
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

void ContactStep(benchmark::State& state, Dynamics dynamics) {
  Rig rig(brush_of_200(state.range(0) != 0), dynamics,
          state.range(1) != 0 ? MotionSpace::rigid : MotionSpace::translation);
  slide(state, rig);
}
BENCHMARK_CAPTURE(ContactStep, quasi_static, Dynamics::quasi_static)
    ->ArgNames({"scattered", "rigid"})
    ->ArgsProduct({{0, 1}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(ContactStep, unit_mass, Dynamics::unit_mass)
    ->ArgNames({"scattered", "rigid"})
    ->ArgsProduct({{0, 1}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

/// By the number of feet, of ten times as many points.
void ContactStep_Feet(benchmark::State& state) {
  Rig rig(brush_of(static_cast<int>(state.range(0))), Dynamics::quasi_static, MotionSpace::rigid);
  slide(state, rig);
}
BENCHMARK(ContactStep_Feet)->ArgName("feet")->Arg(200)->Arg(2000)->Arg(20'000)->Unit(benchmark::kMicrosecond);

/// What it costs when nothing touches.
void FreeStep(benchmark::State& state) {
  Rig rig(brush_of_200(true), Dynamics::unit_mass, MotionSpace::rigid);
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
