/// Edges of an indexed mesh, grouped: shared by all mesh repair steps.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "dismantle/mesh.h"

namespace dismantle::mesh_detail {

/// Corner `corner` of `triangle` to the next one, as an undirected edge lo < hi (or lo == hi if degenerate).
struct EdgeRef {
  std::uint32_t lo, hi;
  std::uint32_t triangle;
  std::uint8_t corner;
  bool forward;  ///< the triangle runs from lo to hi
};

/// All edges, equal ones next to each other, in an order that depends on nothing but the mesh.
inline std::vector<EdgeRef> sorted_edges(const Mesh& mesh) {
  std::vector<EdgeRef> edges;
  edges.reserve(mesh.triangles.size() * 3);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint8_t c = 0; c < 3; ++c) {
      const std::uint32_t a = mesh.triangles[t][c], b = mesh.triangles[t][(c + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, c, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const EdgeRef& x, const EdgeRef& y) {
    if (x.lo != y.lo) return x.lo < y.lo;
    if (x.hi != y.hi) return x.hi < y.hi;
    if (x.triangle != y.triangle) return x.triangle < y.triangle;
    return x.corner < y.corner;
  });
  return edges;
}

/// Calls f(first, last) for each group of references to one undirected edge.
template <class F>
void for_each_edge(const std::vector<EdgeRef>& edges, F&& f) {
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i + 1;
    while (j < edges.size() && edges[j].lo == edges[i].lo && edges[j].hi == edges[i].hi) ++j;
    f(edges.data() + i, edges.data() + j);
    i = j;
  }
}

}  // namespace dismantle::mesh_detail
