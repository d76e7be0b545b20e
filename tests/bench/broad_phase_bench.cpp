// What is asked once per step about all parts that are left, at 10^2 to 10^4 parts: time per step over the number of
// parts is the slope; a figure that grows with it is a square.
#include <benchmark/benchmark.h>

#include <cmath>

#include "dismantle/engine/layout.h"
#include "dismantle/geometry/hull.h"
#include "dismantle/geometry/hulls_apart.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::bench {
namespace {

using Vec3 = Eigen::Vector3d;

/// Pegs on a square grid, one apart.
struct Layout {
  Mesh mesh = shapes::box({-0.3, -0.3, 0}, {0.3, 0.3, 1});
  Aabb box = mesh.box();
  std::vector<Vec3> corners = hull_corners(mesh.vertices);
  std::vector<geometry::PlacedHull> all;

  explicit Layout(std::int64_t count) {
    const auto columns = static_cast<std::int64_t>(std::ceil(std::sqrt(static_cast<double>(count))));
    for (std::int64_t i = 0; i < count; ++i)
      all.push_back({&mesh, &box, &corners,
                     Pose{Vec3(static_cast<double>(i % columns), static_cast<double>(i / columns), 0),
                          Eigen::Quaterniond::Identity()}});
  }
};

/// How far the middle peg has to be taken until its hull is apart from all others, aslant: axes do not tell.
void BroadPhase_HullsApart(benchmark::State& state) {
  const Layout layout(state.range(0));
  std::vector<geometry::PlacedHull> rest = layout.all;
  const geometry::PlacedHull moving = rest[rest.size() / 2];
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(rest.size() / 2));
  const Vec3 displacement = Vec3(0.1, 0.2, 1).normalized();
  double distance = 0;
  for (auto _ : state) distance += geometry::HullsApart({moving}, rest).distance(displacement, 5, 12);
  benchmark::DoNotOptimize(distance);
  state.SetComplexityN(state.range(0));
}
BENCHMARK(BroadPhase_HullsApart)->RangeMultiplier(10)->Range(100, 10'000)->Complexity();

void BroadPhase_LayOut(benchmark::State& state) {
  std::vector<Aabb> boxes;
  Rng rng(1);
  for (std::int64_t i = 0; i < state.range(0); ++i) {
    const Vec3 lo = shapes::random_vector(rng, -5, 5);
    boxes.push_back({lo, lo + shapes::random_vector(rng, 0.05, 0.5)});
  }
  const Aabb taken{Vec3::Constant(-5), Vec3::Constant(5)};
  for (auto _ : state) benchmark::DoNotOptimize(lay_out(boxes, {taken}, Eigen::Vector3d::UnitZ(), 0.5));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(BroadPhase_LayOut)->RangeMultiplier(10)->Range(100, 1'000)->Unit(benchmark::kMillisecond)->Complexity();

}  // namespace
}  // namespace dismantle::bench
