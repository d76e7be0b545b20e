#include "edge_depth.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::mesh_collision {
namespace {

struct End {
  Eigen::Vector3d point;
  double depth = 0;  ///< negative outside
  std::uint32_t triangle = geometry::kNoIndex;
};

End at(const SolidPart& solid, const Eigen::Vector3d& p) {
  const sdf::Sample s = solid.surface->sample(p);
  return {p, -s.value, s.triangle};
}

double distance_to(const SolidPart& solid, std::uint32_t triangle, const Eigen::Vector3d& p) {
  const auto& m = solid.mesh;
  return (p - closest_on_triangle(p, m.vertex(triangle, 0), m.vertex(triangle, 1), m.vertex(triangle, 2))).norm();
}

/// Upper bound of the depth between u and v. Depth is 1-Lipschitz, and the distance to a single triangle is convex, so
/// its maximum is at an end.
double bound(const SolidPart& solid, const End& u, const End& v) {
  const double lipschitz = 0.5 * (u.depth + v.depth + (v.point - u.point).norm());
  double convex = std::max(std::abs(u.depth), distance_to(solid, u.triangle, v.point));
  if (v.triangle != u.triangle)
    convex = std::min(convex, std::max(std::abs(v.depth), distance_to(solid, v.triangle, u.point)));
  return std::min(lipschitz, convex);
}

double bisect(const SolidPart& solid, const End& first, const End& last, double best,
              const DepthGauge::Effort& effort) {
  std::array<std::pair<End, End>, 64> stack;  // depth first: at most one entry per halving
  std::size_t top = 0;
  stack[top++] = {first, last};
  while (top > 0 && best < effort.enough) {
    const auto [u, v] = stack[--top];
    if (bound(solid, u, v) <= best + effort.resolution) continue;
    const End middle = at(solid, 0.5 * (u.point + v.point));
    best = std::max(best, middle.depth);
    if (top + 2 > stack.size()) continue;  // interval below rounding
    stack[top++] = {u, middle};
    stack[top++] = {middle, v};
  }
  return best;
}

}  // namespace

void DepthGauge::begin(const Body& a) {
  if (stamp_.size() < a.graph.edges.size()) stamp_.resize(a.graph.edges.size(), 0);
  ++now_;
  open_.clear();
  crossings_.clear();
}

void DepthGauge::open_corner(const Body& a, std::uint32_t vertex) {
  for (auto i = a.graph.vertex_begin[vertex]; i < a.graph.vertex_begin[vertex + 1]; ++i) {
    const std::uint32_t edge = a.graph.vertex_edges[i];
    if (stamp_[edge] == now_) continue;
    stamp_[edge] = now_;
    open_.push_back(edge);
  }
}

/// Crossings of the edges of a triangle of a with one of b. Grazing ones count: extra crossings do no harm.
void DepthGauge::cross(const Body& a, const Body& b, const Pose& a_to_b, std::uint32_t of_a, std::uint32_t of_b) {
  const Eigen::Vector3d& o = b.mesh.vertex(of_b, 0);
  const Eigen::Vector3d u = b.mesh.vertex(of_b, 1) - o, v = b.mesh.vertex(of_b, 2) - o, n = u.cross(v);
  const double nn = n.squaredNorm();
  if (!(nn > 0)) return;
  std::array<Eigen::Vector3d, 3> corner;
  std::array<double, 3> height{};
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = a_to_b * a.mesh.vertex(of_a, static_cast<int>(k));
    height[k] = n.dot(corner[k] - o);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t m = (k + 1) % 3;
    const double rise = height[k] - height[m];
    if (rise == 0) continue;  // parallel: the edge crosses elsewhere
    const double place = height[k] / rise;
    if (!(place >= -geometry::kRounding && place <= 1 + geometry::kRounding)) continue;
    const Eigen::Vector3d x = corner[k] + place * (corner[m] - corner[k]) - o;
    const double s = n.dot(x.cross(v)) / nn, t = n.dot(u.cross(x)) / nn;
    if (s < -geometry::kRounding || t < -geometry::kRounding || s + t > 1 + geometry::kRounding) continue;
    const std::uint32_t edge = a.graph.of_triangle[of_a][k];
    const bool forward = a.graph.edges[edge][0] == a.mesh.triangles[of_a][k];
    crossings_.push_back({edge, std::clamp(forward ? place : 1 - place, 0.0, 1.0)});
  }
}

double DepthGauge::deepest(const Body& a, const Body& b, const Pose& a_to_b, std::span<const TrianglePair> pairs,
                           bool of_second, const Effort& effort) {
  begin(a);
  for (const auto& pair : pairs) {
    const std::uint32_t of_a = of_second ? pair.b : pair.a, of_b = of_second ? pair.a : pair.b;
    cross(a, b, a_to_b, of_a, of_b);
  }
  std::sort(crossings_.begin(), crossings_.end());
  for (const auto& c : crossings_) {
    if (stamp_[c.edge] == now_) continue;
    stamp_[c.edge] = now_;
    open_.push_back(c.edge);
  }
  return follow(a, b, a_to_b, effort);
}

double DepthGauge::deepest(const Body& a, const Body& b, const Pose& a_to_b, std::span<const std::uint32_t> corners,
                           const Effort& effort) {
  begin(a);
  for (const auto v : corners) open_corner(a, v);
  return follow(a, b, a_to_b, effort);
}

double DepthGauge::follow(const Body& a, const Body& b, const Pose& a_to_b, const Effort& effort) {
  double best = 0;
  for (std::size_t i = 0; i < open_.size() && best < effort.enough; ++i) {
    const auto [v, w] = a.graph.edges[open_[i]];
    const Eigen::Vector3d p = a_to_b * a.mesh.vertices[v], q = a_to_b * a.mesh.vertices[w];
    const auto [first, last] = std::equal_range(crossings_.begin(), crossings_.end(), Crossing{open_[i], 0},
                                                [](const auto& x, const auto& y) { return x.edge < y.edge; });
    double from = 0;
    for (auto c = first;; ++c) {  // the intervals between crossings
      const double to = c == last ? 1.0 : c->place;
      const Eigen::Vector3d middle = p + 0.5 * (from + to) * (q - p);
      const bool stretch = to > from;
      for (const auto& solid : b.solids) {
        if (!stretch || !solid.box.contains(middle)) continue;
        const End inner = at(solid, middle);
        if (!(inner.depth > 0)) continue;
        best = std::max(best, inner.depth);
        if (from == 0) open_corner(a, v);
        if (to == 1) open_corner(a, w);
        if (!effort.thorough) continue;
        const End begin_at = at(solid, p + from * (q - p)), end_at = at(solid, p + to * (q - p));
        best = std::max({best, begin_at.depth, end_at.depth});
        best = bisect(solid, begin_at, inner, best, effort);
        best = bisect(solid, inner, end_at, best, effort);
      }
      if (c == last) break;
      from = to;
    }
  }
  return best;
}

}  // namespace dismantle::mesh_collision
