#include "verify/pocket/free_part.h"

#include <algorithm>
#include <array>
#include <limits>

namespace dismantle::verify {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr std::size_t kMostCorners = 600;  // of a box that meets more than that nothing is said
constexpr std::size_t kMostNormals = 14;
constexpr double kCutsOff = 0.01;  // of the box's width along the normal, cut off
constexpr double kSurfaceRounding = 1e-9;

/// Convex; a triangle cut by six planes has nine corners at most.
struct Polygon {
  std::array<Vec3, 12> corner;
  std::size_t count = 0;
  void add(const Vec3& p) { corner[count++] = p; }
};

/// The part of a triangle within the box about the origin.
Polygon clipped(const std::array<Vec3, 3>& triangle, const Vec3& half) {
  Polygon polygon;
  for (const Vec3& v : triangle) polygon.add(v);
  for (int d = 0; d < 3; ++d)
    for (const double side : {-1.0, 1.0}) {
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
  static thread_local std::vector<Vec3> corners, normals;
  corners.clear();
  normals.clear();
  for (int k = 0; k < 3; ++k)
    for (const double s : {-1.0, 1.0}) normals.push_back(s * Vec3::Unit(k));
  solid.bvh.overlapping(box, [&](std::uint32_t t) {
    if (corners.size() > kMostCorners) return;
    std::array<Vec3, 3> c = solid.bvh.corners(t);
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
  for (int k = 0; k < 8; ++k) {
    const Vec3 c(k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(), k & 4 ? half.z() : -half.z());
    if (!faced.occupied.inside(at + c)) corners.push_back(c);
  }
  for (const Vec3& m : normals) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& c : corners) least = std::min(least, m.dot(c));
    const double width = m.cwiseAbs().dot(half);
    if (least > -width + 2 * kCutsOff * width) result.within.push_back({m, least + m.dot(at) - kSurfaceRounding});
  }
  return result;
}

}  // namespace dismantle::verify
