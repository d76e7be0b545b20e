#include "certificates/section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

namespace dismantle::certificates {

Neighbours neighbours_of(const Body& body) {
  Neighbours all(body.triangles.size(), {kNone, kNone, kNone});
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::pair<std::uint32_t, std::uint32_t>>> unmatched;
  for (std::uint32_t t = 0; t < body.triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = body.triangles[t][k], b = body.triangles[t][(k + 1) % 3];
      auto& opposite = unmatched[{b, a}];
      if (opposite.empty()) {
        unmatched[{a, b}].emplace_back(t, k);
        continue;
      }
      const auto [other, edge] = opposite.back();  // any of several will do: it only matters that edges are paired
      opposite.pop_back();
      all[t][k] = other;
      all[other][edge] = t;
    }
  return all;
}

double Loop::diameter() const {
  double most = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) most = std::max(most, (points[i] - points[k]).squaredNorm());
  return std::sqrt(most);
}

int Loop::turns(const Vec3& p, const Plane& plane) const {
  const Vec3 e = plane.normal.unitOrthogonal(), f = plane.normal.cross(e);
  double turned = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3 a = points[k] - p, b = points[(k + 1) % points.size()] - p;
    const Eigen::Vector2d u(e.dot(a), f.dot(a)), v(e.dot(b), f.dot(b));
    turned += std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v));
  }
  return static_cast<int>(std::lround(turned / (2 * std::numbers::pi)));
}

double Loop::distance(const Vec3& p) const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < points.size(); ++k)
    least = std::min(least, certificates::distance(p, {points[k], points[(k + 1) % points.size()], points[k]}));
  return least;
}

std::vector<Loop> section(const Body& body, const Neighbours& neighbours, const Plane& plane) {
  std::vector<Loop> loops;
  std::vector<char> seen(body.triangles.size(), 0);
  const auto above = [&](std::uint32_t v) { return plane.above(body.vertices[v]); };
  for (std::uint32_t first = 0; first < body.triangles.size(); ++first) {
    Loop loop;
    std::uint32_t t = first;
    while (t != kNone && !seen[t]) {
      // A triangle that is cut has one edge that goes up and one that goes down. The curve enters by the edge that goes
      // down and leaves by the other, where it enters the next triangle.
      std::size_t up = 3, down = 3;
      for (std::size_t k = 0; k < 3; ++k) {
        const bool from = above(body.triangles[t][k]), to = above(body.triangles[t][(k + 1) % 3]);
        if (!from && to) up = k;
        if (from && !to) down = k;
      }
      if (up == 3) break;
      seen[t] = 1;
      const std::uint32_t a = body.triangles[t][down], b = body.triangles[t][(down + 1) % 3];
      loop.points.push_back(plane.cut(body.vertices[a], body.vertices[b]));
      loop.triangles.push_back(t);
      loop.edges.push_back({a, b});
      t = neighbours[t][up];
    }
    if (!loop.points.empty() && t == first) loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace dismantle::certificates
