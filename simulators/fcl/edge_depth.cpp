#include "edge_depth.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::mesh_collision {
namespace {

struct End {
  Eigen::Vector3d point;
  double depth = 0;  ///< negative outside
  std::uint32_t triangle = sdf::kNoTriangle;
};

End at(const SolidPart& solid, const Eigen::Vector3d& p) {
  const sdf::Sample s = solid.surface->sample(p);
  return {p, -s.value, s.triangle};
}

double distance_to(const SolidPart& solid, std::uint32_t triangle, const Eigen::Vector3d& p) {
  const auto& m = solid.mesh;
  return (p - closest_on_triangle(p, m.vertex(triangle, 0), m.vertex(triangle, 1), m.vertex(triangle, 2))).norm();
}

/// No point between u and v is deeper. Depth changes no faster than the point moves; and the distance to any one
/// triangle, which is convex, is largest at an end.
double bound(const SolidPart& solid, const End& u, const End& v) {
  const double lipschitz = 0.5 * (u.depth + v.depth + (v.point - u.point).norm());
  double convex = std::max(std::abs(u.depth), distance_to(solid, u.triangle, v.point));
  if (v.triangle != u.triangle)
    convex = std::min(convex, std::max(std::abs(v.depth), distance_to(solid, v.triangle, u.point)));
  return std::min(lipschitz, convex);
}

/// The box cuts the line to [t0, t1] of [0, 1]; false when it misses it.
bool clip(const Aabb& box, const Eigen::Vector3d& p, const Eigen::Vector3d& q, double& t0, double& t1) {
  t0 = 0;
  t1 = 1;
  for (int k = 0; k < 3; ++k) {
    const double d = q[k] - p[k];
    if (d == 0) {
      if (p[k] < box.lo[k] || p[k] > box.hi[k]) return false;
      continue;
    }
    double in = (box.lo[k] - p[k]) / d, out = (box.hi[k] - p[k]) / d;
    if (in > out) std::swap(in, out);
    t0 = std::max(t0, in);
    t1 = std::min(t1, out);
  }
  return t0 <= t1;
}

}  // namespace

double deepest_on_line(const SolidPart& solid, const Eigen::Vector3d& p, const Eigen::Vector3d& q, double best,
                       double resolution, double enough, bool* inside_p, bool* inside_q) {
  *inside_p = *inside_q = false;
  double t0 = 0, t1 = 1;
  if (!clip(solid.box, p, q, t0, t1)) return best;
  const End first = at(solid, p + t0 * (q - p)), last = at(solid, p + t1 * (q - p));
  *inside_p = t0 == 0 && first.depth > 0;
  *inside_q = t1 == 1 && last.depth > 0;
  best = std::max({best, first.depth, last.depth});
  std::array<std::pair<End, End>, 64> stack;  // depth first: never more than one entry per halving
  std::size_t top = 0;
  stack[top++] = {first, last};
  while (top > 0 && best < enough) {
    const auto [u, v] = stack[--top];
    if (bound(solid, u, v) <= best + resolution) continue;
    const End middle = at(solid, 0.5 * (u.point + v.point));
    best = std::max(best, middle.depth);
    if (top + 2 > stack.size()) continue;  // halved beyond rounding
    stack[top++] = {u, middle};
    stack[top++] = {middle, v};
  }
  return best;
}

void DepthGauge::open(std::uint32_t edge) {
  if (edge == EdgeGraph::kFlat || stamp_[edge] == now_) return;
  stamp_[edge] = now_;
  open_.push_back(edge);
}

double DepthGauge::deepest(const Body& a, const Body& b, const Pose& a_to_b, const std::vector<std::uint32_t>& triangles,
                           double resolution, double enough) {
  if (stamp_.size() < a.graph.edges.size()) stamp_.resize(a.graph.edges.size(), 0);
  ++now_;
  open_.clear();
  for (const auto t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      open(a.graph.of_triangle[t][k]);
      // A triangle within a flat face has no bent edge of its own, but its corners may.
      const auto v = a.mesh.triangles[t][k];
      for (auto e = a.graph.vertex_begin[v]; e < a.graph.vertex_begin[v + 1]; ++e) open(a.graph.vertex_edges[e]);
    }
  return follow(a, b, a_to_b, resolution, enough);
}

double DepthGauge::deepest(const Body& a, const Body& b, const Pose& a_to_b, double resolution, double enough) {
  if (stamp_.size() < a.graph.edges.size()) stamp_.resize(a.graph.edges.size(), 0);
  ++now_;
  open_.clear();
  for (std::uint32_t e = 0; e < a.graph.edges.size(); ++e) open(e);
  return follow(a, b, a_to_b, resolution, enough);
}

double DepthGauge::follow(const Body& a, const Body& b, const Pose& a_to_b, double resolution, double enough) {
  double best = 0;
  for (std::size_t i = 0; i < open_.size() && best < enough; ++i) {
    const auto [v, w] = a.graph.edges[open_[i]];
    const Eigen::Vector3d p = a_to_b * a.mesh.vertices[v], q = a_to_b * a.mesh.vertices[w];
    bool inside_v = false, inside_w = false;
    for (const auto& solid : b.solids) {
      bool in_v = false, in_w = false;
      best = deepest_on_line(solid, p, q, best, resolution, enough, &in_v, &in_w);
      inside_v |= in_v;
      inside_w |= in_w;
    }
    if (inside_v)
      for (auto e = a.graph.vertex_begin[v]; e < a.graph.vertex_begin[v + 1]; ++e) open(a.graph.vertex_edges[e]);
    if (inside_w)
      for (auto e = a.graph.vertex_begin[w]; e < a.graph.vertex_begin[w + 1]; ++e) open(a.graph.vertex_edges[e]);
  }
  return best;
}

}  // namespace dismantle::mesh_collision
