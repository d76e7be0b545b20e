#include "dismantle/immobility/free_space_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

/// Convex; a triangle cut by six planes has nine corners at most.
struct Polygon {
  std::array<Vec3, 12> corner;
  std::size_t count = 0;
  void add(const Vec3& p) { corner[count++] = p; }
};

/// True if the triangle's plane certainly misses the box about the origin. `rounding`: error of a position. The normal
/// is the product of two edges, so its error comes from the edges; for a sliver it is a large share of the normal.
/// Positions are exact to 1e-13 of the coordinates, a ten thousandth of `rounding`.
bool plane_misses_box(const SampledPair::Plane& plane, const Vec3& corner, const Vec3& half, double rounding) {
  const double of_normal = 1e-4 * rounding * plane.edges * (corner.lpNorm<1>() + half.lpNorm<1>());
  return std::abs(plane.normal.dot(corner)) > plane.normal.cwiseAbs().dot(half) + rounding * plane.length + of_normal;
}

/// The part of a triangle within the box about the origin.
Polygon clipped(const std::array<Vec3, 3>& triangle, const Vec3& half) {
  Polygon polygon;
  for (const Vec3& v : triangle) polygon.add(v);
  for (int d = 0; d < 3; ++d)
    for (const double side : {-1.0, 1.0}) {
      bool whole = true;
      for (std::size_t i = 0; i < polygon.count; ++i) whole = whole && side * polygon.corner[i][d] <= half[d];
      if (whole) continue;
      Polygon rest;
      for (std::size_t i = 0; i < polygon.count; ++i) {
        const Vec3 &a = polygon.corner[i], &b = polygon.corner[(i + 1) % polygon.count];
        const double in_a = half[d] - side * a[d], in_b = half[d] - side * b[d];
        if (in_a >= 0) rest.add(a);
        if ((in_a >= 0) == (in_b >= 0)) continue;
        Vec3 x = a + in_a / (in_a - in_b) * (b - a);
        x[d] = side * half[d];
        rest.add(x);
      }
      polygon = rest;
      if (polygon.count == 0) return polygon;
    }
  return polygon;
}

}  // namespace

Vec3 half_space_normal(const Solid& solid, std::uint32_t source) {
  return source < 6 ? Vec3((source % 2 == 0 ? -1.0 : 1.0) * Vec3::Unit(source / 2)) : solid.normals[source - 6];
}

FreeSpaceBound free_space_bound(const SampledPair::Obstacle& obstacle, const Vec3& at, const Vec3& half) {
  FreeSpaceBound result;
  const Solid& solid = *obstacle.solid;
  Aabb box;
  box.extend(Vec3(at - half));
  box.extend(Vec3(at + half));
  if (!box.overlaps(solid.box)) {
    result.all = true;
    return result;
  }
  // Above this, a box is cheaper to divide than to clip: most of its triangles do not matter for its halves.
  constexpr std::size_t kMostCorners = 600;
  // Directions of the box's faces, and eight of the solid's: each costs a pass over all corners.
  constexpr std::size_t kMostNormals = 6 + 8;
  // Every access to a thread_local variable is a call, so both are looked up together and only here.
  struct Normal {
    Vec3 of;
    std::uint32_t source;
  };
  static thread_local struct {
    std::vector<Vec3> corners;
    std::vector<Normal> normals;
  } kept;
  auto& corners = kept.corners;
  auto& normals = kept.normals;
  corners.clear();
  normals.clear();
  for (std::uint32_t k = 0; k < 6; ++k) normals.push_back({half_space_normal(solid, k), k});
  solid.bvh.overlapping(box, [&](std::uint32_t t) {
    if (corners.size() > kMostCorners) return;
    const auto& whole = solid.bvh.corners(t);
    if (plane_misses_box(obstacle.planes[t], whole[0] - at, half, obstacle.rounding)) return;
    std::array<Vec3, 3> c = whole;
    for (Vec3& x : c) x -= at;
    const Polygon polygon = clipped(c, half);
    if (polygon.count == 0) return;
    corners.insert(corners.end(), polygon.corner.begin(),
                   polygon.corner.begin() + static_cast<std::ptrdiff_t>(polygon.count));
    const Vec3& normal = solid.normals[t];
    if (!normal.isZero() && normals.size() < kMostNormals &&
        std::none_of(normals.begin(), normals.end(), [&](const Normal& m) { return m.of.dot(normal) > 0.999; }))
      normals.push_back({normal, 6 + t});
  });
  if (corners.size() > kMostCorners) return result;
  if (corners.empty()) {
    (obstacle.occupied.inside(at) ? result.none : result.all) = true;
    return result;
  }
  // Only half spaces that cut off at least a hundredth of the box's width are worth a row of the linear programs. Free
  // corners of the box may weaken them below that.
  struct Cut {
    Vec3 normal;
    std::uint32_t source;
    double least, enough;
  };
  static thread_local std::vector<Cut> cuts;
  cuts.clear();
  for (const auto& [m, source] : normals) {
    Cut cut{m, source, std::numeric_limits<double>::infinity(), (2 * 0.01 - 1) * m.cwiseAbs().dot(half)};
    for (const Vec3& c : corners) cut.least = std::min(cut.least, cut.normal.dot(c));
    if (cut.least > cut.enough) cuts.push_back(cut);
  }
  for (int k = 0; k < 8 && !cuts.empty(); ++k) {
    const Vec3 c(k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(), k & 4 ? half.z() : -half.z());
    if (std::none_of(cuts.begin(), cuts.end(), [&](const Cut& cut) { return cut.normal.dot(c) < cut.least; }) ||
        obstacle.occupied.inside(at + c))
      continue;
    for (Cut& cut : cuts) cut.least = std::min(cut.least, cut.normal.dot(c));
    std::erase_if(cuts, [](const Cut& cut) { return !(cut.least > cut.enough); });
  }
  for (const Cut& cut : cuts)
    result.half_spaces.push_back({cut.normal, cut.least + cut.normal.dot(at) - obstacle.rounding, cut.source});
  return result;
}

}  // namespace dismantle::immobility
