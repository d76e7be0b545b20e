// Signed distance fields: building and asking.
#include <benchmark/benchmark.h>

#include "bench_models.h"
#include "dismantle/sdf/contact_scene.h"

namespace dismantle::bench {
namespace {

using sdf::DistanceGrid;
using sdf::SurfaceQuery;

/// A block of the size that gives 201 nodes along each axis (padding included), its faces bumpy or flat.
Mesh block_of_201() {
  const double edge = 194 * 0.05;
  return slab(
      41, 41, edge / 40, edge / 40, [](int, int) { return 0.0; },
      [edge](int i, int j) { return edge - ((i + j) % 2 == 0 ? 0.0 : 0.02); });
}

void report(benchmark::State& state, const DistanceGrid& grid, std::size_t triangles) {
  const double nodes = grid.nodes().cast<double>().prod();
  state.counters["nodes"] = nodes;
  state.counters["triangles"] = static_cast<double>(triangles);
  state.counters["MB"] = static_cast<double>(grid.bytes()) / 1e6;
  state.counters["nodes/s"] = benchmark::Counter(nodes, benchmark::Counter::kIsIterationInvariantRate);
}

void build(benchmark::State& state, const Mesh& mesh, const sdf::GridOptions& options = {}) {
  const auto solids = sdf::split_solids(mesh);
  std::unique_ptr<DistanceGrid> grid;
  for (auto _ : state) {
    const SurfaceQuery query(solids[0]);
    grid = std::make_unique<DistanceGrid>(solids[0], query, options);
    benchmark::DoNotOptimize(grid->node(0, 0, 0));
  }
  report(state, *grid, mesh.triangles.size());
}

void FieldBuild_201Cubed(benchmark::State& state) { build(state, block_of_201()); }
void FieldBuild_Bounding(benchmark::State& state) { build(state, block_of_201(), sdf::bounding_grid()); }
BENCHMARK(FieldBuild_Bounding)->Unit(benchmark::kMillisecond);
BENCHMARK(FieldBuild_201Cubed)->Unit(benchmark::kMillisecond);

void FieldBuild_Torus(benchmark::State& state) { build(state, torus(4, 1, 128, 48)); }
BENCHMARK(FieldBuild_Torus)->Unit(benchmark::kMillisecond);

void FieldBuild_Part(benchmark::State& state, const char* name, const char* part) {
  const Assembly assembly = sample(name);
  build(state, *assembly.parts[part_called(assembly, part)].mesh);
}
BENCHMARK_CAPTURE(FieldBuild_Part, peg, "peg_in_hole", "peg")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(FieldBuild_Part, block_with_hole, "peg_in_hole", "block")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(FieldBuild_Part, iso_nut, "bolt_and_nut", "nut")->Unit(benchmark::kMillisecond);

/// All that prepare() does for an assembly, fields and contact points, on one thread.
void ShapesBuild(benchmark::State& state, const char* name) {
  const Assembly assembly = sample(name);
  RunContext context;
  for (auto _ : state) {
    const auto placed = sdf::build_shapes(assembly, {}, context);
    benchmark::DoNotOptimize(placed.size());
  }
}
BENCHMARK_CAPTURE(ShapesBuild, peg_in_hole, "peg_in_hole")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ShapesBuild, bolt_and_nut, "bolt_and_nut")->Unit(benchmark::kMillisecond);

/// A solid, its field, and random points at most `band` off its surface (or anywhere in its box: band 0).
struct Field {
  std::vector<sdf::Solid> solids;
  std::unique_ptr<SurfaceQuery> query;
  std::unique_ptr<DistanceGrid> grid;
  std::vector<Vector3d> points;
  std::vector<std::uint32_t> hints;

  explicit Field(const Mesh& mesh, double band = 0) : solids(sdf::split_solids(mesh)) {
    query = std::make_unique<SurfaceQuery>(solids[0]);
    grid = std::make_unique<DistanceGrid>(solids[0], *query, sdf::GridOptions{});
    const Aabb box = mesh.box();
    Rng rng(1);
    while (points.size() < 4096) {
      Vector3d p;
      for (int a = 0; a < 3; ++a) p[a] = rng.uniform(box.lo[a], box.hi[a]);
      const sdf::Sample s = query->sample(p);
      if (band > 0) p += (rng.uniform(-band, band) - s.value) * s.normal;
      points.push_back(p);
      hints.push_back(s.triangle);
    }
  }
};

template <class Ask>
void ask_all(benchmark::State& state, const Field& field, const Ask& ask) {
  double sum = 0;
  for (auto _ : state)
    for (std::size_t i = 0; i < field.points.size(); ++i) sum += ask(i);
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(field.points.size()));
  state.counters["per_query"] =
      benchmark::Counter(static_cast<double>(field.points.size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void Query_GridValue(benchmark::State& state) {
  const Field field(torus(4, 1, 128, 48));
  ask_all(state, field, [&](std::size_t i) { return field.grid->value(field.points[i]); });
}
BENCHMARK(Query_GridValue);

void Query_GridValueAndGradient(benchmark::State& state) {
  const Field field(torus(4, 1, 128, 48));
  Vector3d gradient;
  ask_all(state, field, [&](std::size_t i) {
    const double v = field.grid->value(field.points[i], gradient);
    return v + gradient.x();
  });
}
BENCHMARK(Query_GridValueAndGradient);

/// The same from the cache: points side by side, as those of one block are.
void Query_GridValueAndGradient_Cached(benchmark::State& state) {
  const Field field(torus(4, 1, 128, 48));
  Rng rng(2);
  std::vector<Vector3d> points;
  for (int i = 0; i < 4096; ++i)
    points.push_back(Vector3d(4, 0, 1) + 0.2 * Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)));
  Vector3d gradient;
  ask_all(state, field, [&](std::size_t i) {
    const double v = field.grid->value(points[i], gradient);
    return v + gradient.x();
  });
}
BENCHMARK(Query_GridValueAndGradient_Cached);

/// What decides that a point is too far to matter.
void Query_GridLowerBound(benchmark::State& state) {
  const Field field(torus(4, 1, 128, 48));
  ask_all(state, field, [&](std::size_t i) { return field.grid->lower_bound(field.points[i]); });
}
BENCHMARK(Query_GridLowerBound);

/// As in a step: near the surface, the closest triangle of the step before at hand.
void Query_ExactNearWithHint(benchmark::State& state) {
  const Field field(torus(4, 1, 128, 48), 0.02);
  ask_all(state, field, [&](std::size_t i) { return field.query->sample(field.points[i], 0.5, field.hints[i]).value; });
}
BENCHMARK(Query_ExactNearWithHint);

void Query_ExactNear(benchmark::State& state) {
  const Field field(torus(4, 1, 128, 48), 0.02);
  ask_all(state, field, [&](std::size_t i) { return field.query->sample(field.points[i], 0.1).value; });
}
BENCHMARK(Query_ExactNear);

void Query_ExactAnywhere(benchmark::State& state) {
  const Field field(torus(4, 1, 128, 48));
  ask_all(state, field, [&](std::size_t i) { return field.query->sample(field.points[i]).value; });
}
BENCHMARK(Query_ExactAnywhere);

/// The whole scene when everything is too far to matter: what culling leaves of many points.
void Scene_UpdateFar(benchmark::State& state) {
  const Assembly assembly = assembly_of({torus(3, 0.5, 160, 64), torus(3, 0.5, 160, 64)});
  RunContext context;
  const auto placed = sdf::build_shapes(assembly, {}, context);
  const double height = static_cast<double>(state.range(0)) / 100;
  sdf::ContactScene scene({{0, &placed[0], Pose{}}}, {{1, &placed[1], Pose{}}}, sdf::DistanceModel::exact, 0.025,
                          [](PartId, PartId) { return 0.0; });
  std::vector<Pose> poses(1);
  std::vector<sdf::ContactPoint> touching;
  double x = 0;
  for (auto _ : state) {
    x += 0.0001;  // a step's way, so that nothing is the same twice
    poses[0].t = Vector3d(0.1 * std::sin(x), 0.1 * std::cos(x), height);
    scene.update(poses, touching);
    benchmark::DoNotOptimize(touching.size());
  }
  const auto points = placed[0].shape->points.points.size() + placed[1].shape->points.points.size();
  state.counters["points"] = static_cast<double>(points);
  state.counters["listed"] = static_cast<double>(touching.size());
  state.counters["queries"] =
      benchmark::Counter(static_cast<double>(scene.distance_queries()), benchmark::Counter::kAvgIterations);
}
BENCHMARK(Scene_UpdateFar)->Arg(1000)->Arg(110)->ArgName("height_percent");

}  // namespace
}  // namespace dismantle::bench
