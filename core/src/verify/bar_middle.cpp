#include "verify/bar_middle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "dismantle/geometry/inner_ball.h"
#include "verify/patch.h"

namespace dismantle::verify {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kSamples = 2'000;  // of the bar's surface

/// To where it is deeper, as far as that goes: a ball that touches a flat facet beside its middle is smaller than the
/// one that fits in. No step leads out of the solid: it is shorter than the distance from the surface.
Vec3 deeper(const Solid& bar, Vec3 p) {
  ClosestPoint at = bar.bvh.closest(p);
  double step = 0.3 * at.distance;
  for (int k = 0; k < 40 && step > 0.01 * at.distance; ++k) {
    const Vec3 next = p + step * (p - at.point).normalized();
    const ClosestPoint there = bar.bvh.closest(next);
    if (there.distance > at.distance) {
      p = next;
      at = there;
    } else {
      step *= 0.5;
    }
  }
  return p;
}

}  // namespace

std::vector<InnerBall> middle_of(const Solid& bar, double least) {
  std::vector<InnerBall> balls;
  const double largest = 0.5 * bar.box.size().minCoeff();
  if (!(largest > least)) return balls;
  double area = 0;
  for (std::size_t t = 0; t < bar.mesh.triangles.size(); ++t) {
    const Vec3 a = bar.mesh.vertex(t, 0);
    area += 0.5 * (bar.mesh.vertex(t, 1) - a).cross(bar.mesh.vertex(t, 2) - a).norm();
  }
  const double spacing = std::max(least, std::sqrt(area / kSamples));
  std::map<std::array<long, 3>, Vec3> centers;  // one in each cell of a grid
  for (std::size_t t = 0; t < bar.mesh.triangles.size(); ++t) {
    const Vec3 a = bar.mesh.vertex(t, 0), u = bar.mesh.vertex(t, 1) - a, v = bar.mesh.vertex(t, 2) - a;
    const auto along_u = static_cast<int>(std::ceil(u.norm() / spacing));
    const auto along_v = static_cast<int>(std::ceil(v.norm() / spacing));
    for (int i = 0; i < along_u; ++i)
      for (int k = 0; k < along_v; ++k) {
        const double x = (i + 0.5) / along_u, y = (k + 0.5) / along_v;
        if (x + y > 1) continue;
        const Vec3 p = a + x * u + y * v;
        const double radius = inner_ball_radius(bar.bvh, p, -bar.normals[t], largest);
        if (!(radius > 0.5 * least)) continue;
        const Vec3 c = p - radius * bar.normals[t];
        centers.try_emplace({std::lround(c.x() / least), std::lround(c.y() / least), std::lround(c.z() / least)}, c);
      }
  }
  for (const auto& [cell, start] : centers) {
    const Vec3 center = deeper(bar, start);
    const double radius = escape_at(center, bar).depth;
    if (radius > least) balls.push_back({bar.frame * center, radius});
  }
  std::stable_sort(balls.begin(), balls.end(),
                   [](const InnerBall& a, const InnerBall& b) { return a.radius > b.radius; });
  return balls;
}

}  // namespace dismantle::verify
