#include "dismantle/immobility/free_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr std::size_t kMostCorners = 600;  // of a box that meets more than that nothing is said
constexpr std::size_t kMostNormals = 14;
constexpr double kCutsOff = 0.01;  // of the box's width along the normal, cut off
constexpr double kSurfaceRounding = 1e-9;
constexpr double kNormalRounding = 1e-13;

/// Convex; a triangle cut by six planes has nine corners at most.
struct Polygon {
  std::array<Vec3, 12> corner;
  std::size_t count = 0;
  void add(const Vec3& p) { corner[count++] = p; }
};

/// Does the triangle's plane miss the box about the origin? The normal of a sliver is not known well, so it is taken
/// with what rounding may have done to it.
bool plane_is_elsewhere(const Pinned::Plane& plane, const Vec3& corner, const Vec3& half) {
  const double reach = 1 + corner.lpNorm<1>();
  return std::abs(plane.normal.dot(corner)) > plane.normal.cwiseAbs().dot(half) + kSurfaceRounding * plane.length +
                                                  kNormalRounding * plane.edges * (1 + plane.edges) * reach;
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

FreePart free_part(const Pinned::Faced& faced, const Vec3& at, const Vec3& half) {
  FreePart result;
  const Solid& solid = *faced.solid;
  Aabb box;
  box.extend(Vec3(at - half));
  box.extend(Vec3(at + half));
  if (!box.overlaps(solid.box)) {
    result.all = true;
    return result;
  }
  static thread_local struct { std::vector<Vec3> corners, normals; } kept;
  auto& corners = kept.corners;  // once: to find what is the thread's own takes a call each time
  auto& normals = kept.normals;
  corners.clear();
  normals.clear();
  for (int k = 0; k < 3; ++k)
    for (const double s : {-1.0, 1.0}) normals.push_back(s * Vec3::Unit(k));
  solid.bvh.overlapping(box, [&](std::uint32_t t) {
    if (corners.size() > kMostCorners) return;
    const auto& whole = solid.bvh.corners(t);
    if (plane_is_elsewhere(faced.planes[t], whole[0] - at, half)) return;
    std::array<Vec3, 3> c = whole;
    for (Vec3& x : c) x -= at;
    const Polygon polygon = clipped(c, half);
    if (polygon.count == 0) return;
    corners.insert(corners.end(), polygon.corner.begin(),
                   polygon.corner.begin() + static_cast<std::ptrdiff_t>(polygon.count));
    const Vec3& normal = solid.normals[t];
    if (!normal.isZero() && normals.size() < kMostNormals &&
        std::none_of(normals.begin(), normals.end(), [&](const Vec3& m) { return m.dot(normal) > 0.999; }))
      normals.push_back(normal);
  });
  if (corners.size() > kMostCorners) return result;
  if (corners.empty()) {
    (faced.occupied.inside(at) ? result.none : result.all) = true;
    return result;
  }
  // Half spaces that cut off something of the box; what is free of its corners may leave them less.
  struct Cut {
    Vec3 normal;
    double least, enough;
  };
  static thread_local std::vector<Cut> cuts;
  cuts.clear();
  for (const Vec3& m : normals) {
    Cut cut{m, std::numeric_limits<double>::infinity(), (2 * kCutsOff - 1) * m.cwiseAbs().dot(half)};
    for (const Vec3& c : corners) cut.least = std::min(cut.least, m.dot(c));
    if (cut.least > cut.enough) cuts.push_back(cut);
  }
  for (int k = 0; k < 8 && !cuts.empty(); ++k) {
    const Vec3 c(k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(), k & 4 ? half.z() : -half.z());
    if (std::none_of(cuts.begin(), cuts.end(), [&](const Cut& cut) { return cut.normal.dot(c) < cut.least; }) ||
        faced.occupied.inside(at + c))
      continue;
    for (Cut& cut : cuts) cut.least = std::min(cut.least, cut.normal.dot(c));
    std::erase_if(cuts, [](const Cut& cut) { return !(cut.least > cut.enough); });
  }
  for (const Cut& cut : cuts) result.within.push_back({cut.normal, cut.least + cut.normal.dot(at) - kSurfaceRounding});
  return result;
}

}  // namespace dismantle::immobility
