#include "dismantle/immobility/medial_balls.h"

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
#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/patch.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility/query.h"
#include "dismantle/part_memo.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

/// parallel_for in chunks: a triangle or a ball takes too little time to be a task of its own.
template <class Body>
void for_each_in_chunks(std::size_t count, const RunContext& context, const Body& body) {
  constexpr std::size_t kChunk = 64;
  parallel_for((count + kChunk - 1) / kChunk, context,
               [&](std::size_t c) {
                 for (std::size_t k = c * kChunk; k < std::min((c + 1) * kChunk, count); ++k) body(k);
               },
               [&] { return context.should_stop(); });
}

/// Moves a centre to larger distances from the surface; steps that do not help are halved. This is needed since a ball
/// that touches a flat facet beside its middle is smaller than the largest one nearby. Steps are shorter than the
/// distance, so none leaves the solid. The triangle that refused the last step mostly refuses the next one, so it is
/// tried first, and it bounds the search for a closer triangle.
Vec3 climbed(const Solid& bar, Vec3 p) {
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

std::vector<MedialBall> medial_balls(const Solid& bar, double least, const RunContext& context) {
  std::vector<MedialBall> balls;
  const double largest = 0.5 * bar.box.size().minCoeff();  // no ball within the box is larger
  if (!(largest > least)) return balls;
  double area = 0;
  for (std::size_t t = 0; t < bar.mesh.triangles.size(); ++t) area += 0.5 * geometry::area_vector(bar.mesh, t).norm();
  // About 2000 samples of the surface: fewer miss thin branches, and each costs a few distance queries.
  const double spacing = std::max(least, std::sqrt(area / 2000));
  std::vector<std::vector<Vec3>> below(bar.mesh.triangles.size());  // by triangle: centres of balls that touch it
  for_each_in_chunks(below.size(), context, [&](std::size_t t) {
    const Vec3 a = bar.mesh.vertex(t, 0), u = bar.mesh.vertex(t, 1) - a, v = bar.mesh.vertex(t, 2) - a;
    const auto along_u = static_cast<int>(std::ceil(u.norm() / spacing));
    const auto along_v = static_cast<int>(std::ceil(v.norm() / spacing));
    for (int i = 0; i < along_u; ++i)
      for (int k = 0; k < along_v; ++k) {
        const double x = (i + 0.5) / along_u, y = (k + 0.5) / along_v;
        if (x + y > 1) continue;
        const Vec3 p = a + x * u + y * v;
        const double radius = inner_ball_radius(bar.bvh, p, -bar.normals[t], largest);
        if (radius > 0.5 * least) below[t].push_back(p - radius * bar.normals[t]);  // climbing at most doubles it
      }
  });
  if (context.should_stop()) return balls;
  std::map<std::array<long, 3>, Vec3> first;  // the first centre in each cell of a grid
  for (const auto& centers : below)
    for (const Vec3& c : centers)
      first.try_emplace({std::lround(c.x() / least), std::lround(c.y() / least), std::lround(c.z() / least)}, c);
  std::vector<MedialBall> all;
  for (const auto& [cell, center] : first) all.push_back({center, 0});
  for_each_in_chunks(all.size(), context, [&](std::size_t k) {
    const Vec3 center = climbed(bar, all[k].center);
    all[k] = {bar.frame * center, escape_at(center, bar).depth};
  });
  std::copy_if(all.begin(), all.end(), std::back_inserter(balls),
               [&](const MedialBall& ball) { return ball.radius > least; });
  std::stable_sort(balls.begin(), balls.end(),
                   [](const MedialBall& a, const MedialBall& b) { return a.radius > b.radius; });
  return balls;
}

const std::vector<std::vector<MedialBall>>* medial_balls_of(const SeparationQuery& query, PartId part,
                                                            const RunContext& context) {
  using Balls = std::vector<std::vector<MedialBall>>;
  // A ball as large as the tolerance blocks nothing. A tenth more is the least radius that a proof can use.
  const double least = 1.1 * query.tolerance;
  return query.memo.get<Balls>("medial balls above " + std::to_string(least), part, context,
                               [&]() -> std::optional<Balls> {
                                 Balls all;
                                 for (const Solid& solid : solids_of(query, part))
                                   all.push_back(medial_balls(solid, least, context));
                                 if (context.should_stop()) return std::nullopt;
                                 return all;
                               });
}

}  // namespace dismantle::immobility
