/// Edges of an indexed mesh, grouped by vertex pair.
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

/// Sorts items by ascending key(item), which is below `keys`, and items with equal keys by `less`. Linear in the number
/// of items if few of them share a key, as with edges at a vertex.
template <class Item, class Key, class Less>
std::vector<Item> sorted_by_key(const std::vector<Item>& items, std::size_t keys, Key&& key, Less&& less) {
  std::vector<std::size_t> begin(keys + 1, 0);
  for (const Item& item : items) ++begin[key(item) + 1];
  for (std::size_t k = 0; k < keys; ++k) begin[k + 1] += begin[k];
  std::vector<Item> sorted(items.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (const Item& item : items) sorted[next[key(item)]++] = item;
  for (std::size_t k = 0; k < keys; ++k)
    std::sort(sorted.data() + begin[k], sorted.data() + begin[k + 1], less);
  return sorted;
}

/// All edges, equal ones next to each other, in an order that depends only on the mesh.
inline std::vector<EdgeRef> sorted_edges(const Mesh& mesh) {
  std::vector<EdgeRef> edges;
  edges.reserve(mesh.triangles.size() * 3);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint8_t c = 0; c < 3; ++c) {
      const std::uint32_t a = mesh.triangles[t][c], b = mesh.triangles[t][(c + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, c, a < b});
    }
  const auto less = [](const EdgeRef& x, const EdgeRef& y) {
    if (x.hi != y.hi) return x.hi < y.hi;
    if (x.triangle != y.triangle) return x.triangle < y.triangle;
    return x.corner < y.corner;
  };
  return sorted_by_key(edges, mesh.vertices.size(), [](const EdgeRef& e) { return e.lo; }, less);
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
