// Does a pile stand? States along an order, of about 10 and about 72 parts.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "dismantle/samples/samples.h"
#include "dismantle/statics/built.h"
#include "dismantle/statics/verdict.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::bench {
namespace {

using Eigen::Vector3d;

/// Parts in the order in which they are put together; the first `fixed` do not move.
struct Parts {
  std::vector<Mesh> meshes;
  std::size_t fixed = 0;
};

Parts parts_of(const std::string& sample, const ParamSet& params) {
  Parts parts{{}, 1};
  for (const RawPart& part : samples::make_model(sample, params).parts) parts.meshes.push_back(part.mesh);
  return parts;
}

/// Bricks in running bond, row by row, on a ground. All states stand.
Parts wall(int rows, int columns) {
  Parts parts{{shapes::box({-1, -1, -1}, {columns + 2.0, 2, 0})}, 1};
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double x = column + 0.5 * (row % 2), z = 0.4 * row;
      parts.meshes.push_back(shapes::box({x, 0, z}, {x + 1, 0.5, z + 0.4}));
    }
  return parts;
}

/// Rows of three blocks between two walls, nothing below: only pressure keeps them up.
Parts between_walls(int rows) {
  Parts parts{{shapes::box({-1, -1, -1}, {0, 2, 2.0 * rows}), shapes::box({3, -1, -1}, {4, 2, 2.0 * rows})}, 2};
  for (int row = 0; row < rows; ++row)
    for (int k = 0; k < 3; ++k)
      parts.meshes.push_back(shapes::box({1.0 * k, 0, 2.0 * row}, {k + 1.0, 1, 2 * row + 1.0}));
  return parts;
}

Parts arch_10() { return parts_of("arch", {{"voussoirs", std::int64_t{9}}, {"thickness", 25.0}}); }
Parts dome_74() { return parts_of("dome", {{"rings", std::int64_t{6}}, {"segments", std::int64_t{12}}}); }

/// Judges the last three states of the order in turn, with friction 0.6. Contacts are found beforehand: only the solver
/// is measured.
template <class Judge>
void run(benchmark::State& state, Parts (*make)(), Judge judge) {
  constexpr std::size_t kStates = 3;
  const Parts parts = make();
  const Assembly assembly = shapes::assembly_of(parts.meshes);
  statics::StabilityOptions options;
  options.friction = 0.6;
  options.fixed.assign(parts.meshes.size(), false);
  std::fill_n(options.fixed.begin(), parts.fixed, true);
  const statics::BuiltPiles built(assembly, options);
  std::vector<PlacedPart> there;
  std::vector<statics::Pile> piles;
  for (PartId id = 0; id < parts.meshes.size(); ++id) {
    there.push_back({id, {}});
    if (id + kStates >= parts.meshes.size())
      piles.push_back(built.pile(there, Vector3d::UnitZ(), statics::Gaps::tight, false).pile);
  }
  std::size_t at = 0;
  std::array<std::size_t, 4> counts{};
  for (auto _ : state) {
    ++counts[static_cast<std::size_t>(judge(piles[at]).verdict)];
    at = (at + 1) % piles.size();
  }
  for (const statics::Verdict v :
       {statics::Verdict::stands, statics::Verdict::falls, statics::Verdict::pressed_in, statics::Verdict::uncertain})
    state.counters[std::string(to_string(v))] =
        static_cast<double>(counts[static_cast<std::size_t>(v)]) / static_cast<double>(state.iterations());
}

/// Do forces in equilibrium exist? What a step of a plan asks.
void StaticsForces(benchmark::State& state, Parts (*make)()) {
  run(state, make, [](const statics::Pile& pile) { return statics::judge_forces(pile); });
}
/// The verdict in the strict sense, as `dismantle stability` gives it.
void StaticsVerdict(benchmark::State& state, Parts (*make)()) {
  run(state, make, [](const statics::Pile& pile) { return statics::judge(pile); });
}

Parts wall_10() { return wall(3, 3); }
Parts wall_72() { return wall(8, 9); }
Parts pressed_11() { return between_walls(3); }
Parts pressed_74() { return between_walls(24); }

#define DISMANTLE_STATICS_BENCH(make)                                          \
  BENCHMARK_CAPTURE(StaticsForces, make, make)->Unit(benchmark::kMillisecond); \
  BENCHMARK_CAPTURE(StaticsVerdict, make, make)->Unit(benchmark::kMillisecond)

DISMANTLE_STATICS_BENCH(wall_10);
DISMANTLE_STATICS_BENCH(arch_10);
DISMANTLE_STATICS_BENCH(pressed_11);
DISMANTLE_STATICS_BENCH(wall_72);
DISMANTLE_STATICS_BENCH(dome_74);
DISMANTLE_STATICS_BENCH(pressed_74);

}  // namespace
}  // namespace dismantle::bench
