#include "solid/pinches.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "dismantle/geometry/disjoint_sets.h"
#include "dismantle/geometry/mesh_edges.h"

namespace dismantle::geometry {
namespace {

using Vec3 = Eigen::Vector3d;
using mesh_detail::EdgeRef;

/// Corners of triangles, as 3 * triangle + corner.
class Fans {
 public:
  explicit Fans(const Mesh& mesh) : mesh_(mesh), corners_(3 * mesh.triangles.size()) {}

  /// The triangles of two references continue each other across the edge.
  void join(const EdgeRef& a, const EdgeRef& b) {
    corners_.join(corner(a, a.lo), corner(b, b.lo));
    corners_.join(corner(a, a.hi), corner(b, b.hi));
  }

  /// Joins the triangles around an edge of more than two that have the same material between them.
  void join_sheets(const EdgeRef* first, const EdgeRef* last) {
    // Seen along the edge, the material is behind a triangle that runs along it, and before one that runs against it.
    std::vector<std::pair<double, const EdgeRef*>> around;
    const Vec3 along = (mesh_.vertices[first->hi] - mesh_.vertices[first->lo]).normalized();
    const Vec3 u = along.unitOrthogonal(), v = along.cross(u);
    for (const EdgeRef* e = first; e != last; ++e) {
      const Vec3 across = mesh_.vertices[mesh_.triangles[e->triangle][(e->corner + 2u) % 3]] - mesh_.vertices[e->lo];
      around.emplace_back(std::atan2(across.dot(v), across.dot(u)), e);
    }
    std::sort(around.begin(), around.end());
    const std::size_t count = around.size();
    bool in_turns = count % 2 == 0;
    for (std::size_t k = 0; k < count; ++k)
      in_turns = in_turns && around[k].second->forward != around[(k + 1) % count].second->forward;
    for (std::size_t k = 0; k < count; ++k) {
      const EdgeRef &a = *around[k].second, &b = *around[(k + 1) % count].second;
      if (!in_turns || !a.forward) join(a, b);
    }
  }

  std::uint32_t of(std::size_t triangle, std::size_t corner) {
    return corners_.root(static_cast<std::uint32_t>(3 * triangle + corner));
  }

 private:
  std::uint32_t corner(const EdgeRef& e, std::uint32_t vertex) const {
    const bool at_first = mesh_.triangles[e.triangle][e.corner] == vertex;
    return 3 * e.triangle + (e.corner + (at_first ? 0u : 1u)) % 3;
  }

  const Mesh& mesh_;
  DisjointSets corners_;
};

}  // namespace

Mesh without_pinches(Mesh mesh) {
  Fans fans(mesh);
  const std::vector<EdgeRef> edges = mesh_detail::sorted_edges(mesh);
  mesh_detail::for_each_edge(edges, [&](const EdgeRef* first, const EdgeRef* last) {
    if (first->lo == first->hi) return;
    if (last - first > 2)
      fans.join_sheets(first, last);
    else if (last - first == 2)
      fans.join(first[0], first[1]);
  });
  constexpr auto kNone = static_cast<std::uint32_t>(-1);
  std::vector<std::uint32_t> fan(mesh.vertices.size(), kNone);  // the first fan of a vertex keeps it
  std::map<std::uint32_t, std::uint32_t> others;  // the vertex of another fan
  std::vector<Triangle> triangles = mesh.triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k], own = fans.of(t, k);
      if (fan[v] == kNone) fan[v] = own;
      if (fan[v] == own) continue;
      const auto [other, is_new] = others.try_emplace(own, static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(Vec3(mesh.vertices[v]));
      triangles[t][k] = other->second;
    }
  mesh.triangles = std::move(triangles);
  return mesh;
}

}  // namespace dismantle::geometry
