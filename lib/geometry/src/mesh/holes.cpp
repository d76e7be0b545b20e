#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>

#include "dismantle/geometry/mesh_edges.h"
#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/mesh_repair.h"
#include "mesh/ring_holes.h"
#include "mesh/slits.h"

namespace dismantle {
namespace {

using Eigen::Vector3d;

/// Areas this near count as equal, so that a part that is turned gets the same triangles.
constexpr double kEqualArea = 1e-9;

struct OnEdge {
  double place;  // along the edge, (0, 1)
  std::uint32_t vertex;
};

/// Vertices of open edges, found by their coordinate on one axis.
class OpenVertices {
 public:
  OpenVertices(const Mesh& mesh, const std::vector<mesh_detail::EdgeRef>& open) : mesh_(mesh) {
    mesh.box().size().maxCoeff(&axis_);
    for (const auto& e : open) order_.insert(order_.end(), {e.lo, e.hi});
    std::sort(order_.begin(), order_.end());
    order_.erase(std::unique(order_.begin(), order_.end()), order_.end());
    std::stable_sort(order_.begin(), order_.end(), [&](auto a, auto b) { return at(a) < at(b); });
  }

  /// Vertices strictly between the ends of the edge (a, b), in order from a, without the triangle's own corners.
  std::vector<OnEdge> on(const Triangle& triangle, std::uint32_t a, std::uint32_t b, double tolerance) const {
    std::vector<OnEdge> found;
    const Vector3d &p = mesh_.vertices[a], d = mesh_.vertices[b] - p;
    const double length = d.norm();
    const double lo = std::min(at(a), at(b)) - tolerance, hi = std::max(at(a), at(b)) + tolerance;
    auto it = std::lower_bound(order_.begin(), order_.end(), lo, [&](auto v, double x) { return at(v) < x; });
    for (; it != order_.end() && at(*it) <= hi; ++it) {
      if (*it == triangle[0] || *it == triangle[1] || *it == triangle[2]) continue;
      const Vector3d r = mesh_.vertices[*it] - p;
      const double along = r.dot(d) / length;
      if (along <= tolerance || along >= length - tolerance) continue;
      if ((r - along / length * d).norm() <= tolerance) found.push_back({along / length, *it});
    }
    std::sort(found.begin(), found.end(), [](const OnEdge& x, const OnEdge& y) {
      return x.place != y.place ? x.place < y.place : x.vertex < y.vertex;
    });
    return found;
  }

 private:
  double at(std::uint32_t v) const { return mesh_.vertices[v][axis_]; }
  const Mesh& mesh_;
  Eigen::Index axis_ = 0;
  std::vector<std::uint32_t> order_;
};

std::vector<mesh_detail::EdgeRef> open_edges(const Mesh& mesh) {
  std::vector<mesh_detail::EdgeRef> open;
  mesh_detail::for_each_edge(mesh_detail::sorted_edges(mesh), [&](const auto* first, const auto* last) {
    if (last - first == 1) open.push_back(*first);
  });
  return open;
}

/// Simple closed loops of open edges, in the orientation of a filling; edges outside loops are omitted.
std::vector<std::vector<std::uint32_t>> hole_loops(const Mesh& mesh) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> next;
  for (const auto& e : open_edges(mesh)) {
    if (e.forward)
      next[e.hi].push_back(e.lo);
    else
      next[e.lo].push_back(e.hi);
  }
  std::vector<std::vector<std::uint32_t>> loops;
  while (!next.empty()) {
    std::vector<std::uint32_t> chain{next.begin()->first};
    while (!chain.empty()) {
      const auto found = next.find(chain.back());
      if (found == next.end()) {  // dead end: inconsistent surface
        chain.pop_back();
        continue;
      }
      const std::uint32_t to = found->second.back();
      found->second.pop_back();
      if (found->second.empty()) next.erase(found);
      const auto seen = std::find(chain.begin(), chain.end(), to);
      if (seen == chain.end()) {
        chain.push_back(to);
        continue;
      }
      loops.emplace_back(seen, chain.end());
      chain.erase(seen + 1, chain.end());
    }
  }
  return loops;
}

/// The triangulation of a closed polygon in space with the smallest area (Barequet and Sharir 1995), O(n^3).
std::vector<Triangle> smallest_surface(const std::vector<Vector3d>& p) {
  const std::size_t n = p.size();
  std::vector<double> area(n * n, 0);
  std::vector<std::uint32_t> apex(n * n, 0);
  for (std::size_t span = 2; span < n; ++span)
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t k = i + span;
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t m = i + 1; m < k; ++m) {
        const double a = area[i * n + m] + area[m * n + k] + (p[m] - p[i]).cross(p[k] - p[i]).norm() / 2;
        if (a < (1 - kEqualArea) * best || std::isinf(best)) {
          best = a;
          apex[i * n + k] = static_cast<std::uint32_t>(m);
        }
      }
      area[i * n + k] = best;
    }
  std::vector<Triangle> out;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pending{{0, static_cast<std::uint32_t>(n - 1)}};
  while (!pending.empty()) {
    const auto [i, k] = pending.back();
    pending.pop_back();
    if (k - i < 2) continue;
    const std::uint32_t m = apex[i * n + k];
    out.push_back({i, m, k});
    pending.emplace_back(i, m);
    pending.emplace_back(m, k);
  }
  return out;
}

double area_of(const std::vector<Vector3d>& p, const std::vector<Triangle>& triangles) {
  double twice = 0;
  for (const auto& t : triangles) twice += (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).norm();
  return twice / 2;
}

}  // namespace

std::size_t close_t_junctions(Mesh& mesh, double tolerance) {
  std::size_t count = 0;
  for (int pass = 0; pass < 32; ++pass) {  // one pass splits a triangle at one edge
    const auto open = open_edges(mesh);
    if (open.empty()) break;
    const OpenVertices vertices(mesh, open);
    std::vector<char> done(mesh.triangles.size(), 0);
    std::size_t in_pass = 0;
    for (const auto& e : open) {
      if (done[e.triangle]) continue;
      const Triangle t = mesh.triangles[e.triangle];
      const std::uint32_t a = t[e.corner], b = t[(e.corner + 1) % 3u], c = t[(e.corner + 2) % 3u];
      const auto on = vertices.on(t, a, b, tolerance);
      if (on.empty()) continue;
      done[e.triangle] = 1;
      ++in_pass;
      std::uint32_t from = a;
      for (std::size_t k = 0; k < on.size(); ++k) {
        const Triangle piece{from, on[k].vertex, c};
        if (k == 0)
          mesh.triangles[e.triangle] = piece;
        else
          mesh.triangles.push_back(piece);
        from = on[k].vertex;
      }
      mesh.triangles.push_back({from, b, c});
    }
    if (in_pass == 0) break;
    count += in_pass;
  }
  return count;
}

std::vector<Hole> fill_holes(Mesh& mesh, const HoleLimits& limits) {
  std::vector<Hole> holes;
  const double area_limit = limits.max_area_share * surface_area(mesh);
  const auto loops = mesh_detail::join_ring_holes(mesh, hole_loops(mesh));
  const std::vector<char> slits = mesh_detail::close_slits(mesh, loops);
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const auto& loop = loops[k];
    Hole hole;
    hole.slit = slits[k] != 0;
    hole.edges = loop.size();
    std::vector<Vector3d> corners;
    Aabb box;
    for (const auto v : loop) {
      corners.push_back(mesh.vertices[v]);
      box.extend(corners.back());
      hole.center += corners.back() / static_cast<double>(loop.size());
    }
    Vector3d normal = Vector3d::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i)
      normal += (corners[i] - hole.center).cross(corners[(i + 1) % corners.size()] - hole.center);
    hole.area = normal.norm() / 2;
    double uneven = 0;
    if (hole.area > 0)
      for (const auto& p : corners) uneven = std::max(uneven, std::abs(normal.normalized().dot(p - hole.center)));
    hole.flat = loop.size() <= 3 || uneven <= limits.max_unevenness * box.size().norm();
    std::vector<Triangle> filling;
    if (hole.slit) {
      hole.filled = true;
      holes.push_back(std::move(hole));
      continue;
    }
    if (loop.size() < 3) {
      hole.why_not = "two triangles overlap there";
    } else if (loop.size() > (hole.flat ? limits.max_edges : limits.max_uneven_edges)) {
      hole.why_not = fmt::format("more than {} edges{}", hole.flat ? limits.max_edges : limits.max_uneven_edges,
                                 hole.flat ? "" : " that do not lie in a plane");
    } else {
      filling = hole.flat ? triangulate_polygon(corners) : smallest_surface(corners);
      if (filling.empty()) {
        hole.why_not = "its rim crosses itself";
      } else {
        hole.area = area_of(corners, filling);
        if (hole.area > area_limit) {
          hole.why_not = fmt::format("larger than {:g} % of the surface", 100 * limits.max_area_share);
          filling.clear();
        }
      }
    }
    for (const auto& t : filling) mesh.triangles.push_back({loop[t[0]], loop[t[1]], loop[t[2]]});
    hole.filled = !filling.empty();
    holes.push_back(std::move(hole));
  }
  return holes;
}

}  // namespace dismantle
