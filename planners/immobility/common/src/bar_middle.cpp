#include "dismantle/immobility/bar_middle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <string>

#include "dismantle/executor.h"
#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/inner_ball.h"
#include "dismantle/geometry/patch.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility/query.h"
#include "dismantle/part_memo.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kSamples = 2'000;  // of the bar's surface
constexpr double kDeeper = 1.1;     // of the tolerance: balls that are no larger say nothing
constexpr std::size_t kChunk = 64;  // triangles, or balls, that a thread takes at a time

std::size_t chunks(std::size_t count) { return (count + kChunk - 1) / kChunk; }

/// To where it is deeper, as far as that goes: a ball that touches a flat facet beside its middle is smaller than the
/// one that fits in. No step leads out of the solid: it is shorter than the distance from the surface.
/// A step is refused as soon as one triangle is known to be too close, mostly the one that refused the step before;
/// and no triangle is looked at that is further away than one of those.
Vec3 deeper(const Solid& bar, Vec3 p) {
  constexpr double kRounding = 1e-9;  // relative
  const auto distance_to = [&](std::uint32_t triangle, const Vec3& from) {
    const auto& c = bar.bvh.corners(triangle);
    return (closest_on_triangle(from, c[0], c[1], c[2]) - from).norm();
  };
  ClosestPoint at = bar.bvh.closest(p);
  std::uint32_t refused = at.triangle;
  double step = 0.3 * at.distance;
  for (int k = 0; k < 40 && step > 0.01 * at.distance; ++k) {
    const Vec3 next = p + step * (p - at.point).normalized();
    const double bound = std::min(distance_to(refused, next), distance_to(at.triangle, next));
    if (bound > at.distance) {
      const ClosestPoint there = bar.bvh.closest(next, bound * (1 + kRounding));
      if (there.distance > at.distance) {
        p = next;
        at = there;
        continue;
      }
      refused = there.triangle;
    }
    step *= 0.5;
  }
  return p;
}

}  // namespace

std::vector<InnerBall> middle_of(const Solid& bar, double least, const RunContext& context) {
  std::vector<InnerBall> balls;
  const double largest = 0.5 * bar.box.size().minCoeff();
  if (!(largest > least)) return balls;
  double area = 0;
  for (std::size_t t = 0; t < bar.mesh.triangles.size(); ++t) area += 0.5 * geometry::area_vector(bar.mesh, t).norm();
  const double spacing = std::max(least, std::sqrt(area / kSamples));
  const auto stop = [&] { return context.should_stop(); };
  std::vector<std::vector<Vec3>> below(bar.mesh.triangles.size());  // by triangle: centres of balls that touch it
  parallel_for(
      chunks(below.size()), context,
      [&](std::size_t chunk) {
        for (std::size_t t = chunk * kChunk; t < std::min((chunk + 1) * kChunk, below.size()); ++t) {
          const Vec3 a = bar.mesh.vertex(t, 0), u = bar.mesh.vertex(t, 1) - a, v = bar.mesh.vertex(t, 2) - a;
          const auto along_u = static_cast<int>(std::ceil(u.norm() / spacing));
          const auto along_v = static_cast<int>(std::ceil(v.norm() / spacing));
          for (int i = 0; i < along_u; ++i)
            for (int k = 0; k < along_v; ++k) {
              const double x = (i + 0.5) / along_u, y = (k + 0.5) / along_v;
              if (x + y > 1) continue;
              const Vec3 p = a + x * u + y * v;
              const double radius = inner_ball_radius(bar.bvh, p, -bar.normals[t], largest);
              if (radius > 0.5 * least) below[t].push_back(p - radius * bar.normals[t]);
            }
        }
      },
      stop);
  if (stop()) return balls;
  std::map<std::array<long, 3>, Vec3> first;  // one in each cell of a grid
  for (const auto& centers : below)
    for (const Vec3& c : centers)
      first.try_emplace({std::lround(c.x() / least), std::lround(c.y() / least), std::lround(c.z() / least)}, c);
  std::vector<InnerBall> all;
  for (const auto& [cell, center] : first) all.push_back({center, 0});
  parallel_for(
      chunks(all.size()), context,
      [&](std::size_t chunk) {
        for (std::size_t k = chunk * kChunk; k < std::min((chunk + 1) * kChunk, all.size()); ++k) {
          const Vec3 center = deeper(bar, all[k].center);
          all[k] = {bar.frame * center, escape_at(center, bar).depth};
        }
      },
      stop);
  std::copy_if(all.begin(), all.end(), std::back_inserter(balls),
               [&](const InnerBall& ball) { return ball.radius > least; });
  std::stable_sort(balls.begin(), balls.end(),
                   [](const InnerBall& a, const InnerBall& b) { return a.radius > b.radius; });
  return balls;
}

const std::vector<std::vector<InnerBall>>* middles_of(const SeparationQuery& query, PartId part,
                                                      const RunContext& context) {
  using Middles = std::vector<std::vector<InnerBall>>;
  const double least = kDeeper * query.tolerance;
  return query.memo.get<Middles>("middles above " + std::to_string(least), part, context,
                                 [&]() -> std::optional<Middles> {
                                   Middles all;
                                   for (const Solid& solid : solids_of(query, part))
                                     all.push_back(middle_of(solid, least, context));
                                   if (context.should_stop()) return std::nullopt;
                                   return all;
                                 });
}

}  // namespace dismantle::immobility
