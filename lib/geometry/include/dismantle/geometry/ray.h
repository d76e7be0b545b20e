/// First hit of a short ray on a triangle hierarchy.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::geometry {

/// Distance along `direction` (unit) from `from` to the first triangle with `counts(triangle)`, infinity if there is
/// none within `reach`. Triangles parallel to the ray are not hit.
template <class Counts>
double first_hit(const TriangleBvh& bvh, const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double reach,
                 const Counts& counts) {
  using Vec3 = Eigen::Vector3d;
  double best = std::numeric_limits<double>::infinity();
  if (bvh.nodes().empty()) return best;
  const auto segment_box = [&](double length) {
    Aabb b;
    b.extend(from);
    b.extend(Vec3(from + length * direction));
    return b;
  };
  Aabb segment = segment_box(reach);
  // The box around an oblique ray may meet boxes that the ray itself does not.
  const Vec3 size = direction.cwiseAbs();
  const auto passed_by = [&](const Aabb& box) {
    const Vec3 to = from - box.center(), half = 0.5 * box.size(), off = to.cross(direction).cwiseAbs();
    const double rounding = 1e-9 * (to.norm() + half.norm());
    return off.x() > half.y() * size.z() + half.z() * size.y() + rounding ||
           off.y() > half.x() * size.z() + half.z() * size.x() + rounding ||
           off.z() > half.x() * size.y() + half.y() * size.x() + rounding;
  };
  std::array<std::uint32_t, 192> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t id = stack[--top];
    const TriangleBvh::Node& node = bvh.nodes()[id];
    if (!node.box.overlaps(segment) || passed_by(node.box)) continue;
    if (node.count == 0) {
      stack[top++] = node.first;
      stack[top++] = id + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const std::uint32_t t = bvh.order()[i];
      const auto& c = bvh.corners(t);
      const Vec3 e1 = c[1] - c[0], e2 = c[2] - c[0], p = direction.cross(e2);
      const double det = e1.dot(p);
      if (std::abs(det) <= 1e-12 * e1.norm() * e2.norm()) continue;
      const Vec3 s = from - c[0], q = s.cross(e1);
      const double u = s.dot(p) / det, v = direction.dot(q) / det, d = e2.dot(q) / det;
      if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9 || d < 0 || d > reach || d >= best) continue;
      if (!counts(t)) continue;
      best = d;
      segment = segment_box(best);
    }
  }
  return best;
}

}  // namespace dismantle::geometry
