#include <array>
#include <bit>
#include <unordered_map>

#include "dismantle/geometry/mesh_edges.h"
#include "dismantle/geometry/mesh_repair.h"
#include "dismantle/geometry/numerics.h"

namespace dismantle {
namespace {

using geometry::kNoIndex;

using Key = std::array<std::int64_t, 3>;
struct KeyHash {
  std::size_t operator()(const Key& k) const {
    std::uint64_t h = 0x9E3779B97F4A7C15ull;
    for (const std::int64_t x : k) h = (h ^ static_cast<std::uint64_t>(x)) * 0xBF58476D1CE4E5B9ull, h ^= h >> 29;
    return static_cast<std::size_t>(h);
  }
};

/// For each vertex the first vertex at the same position.
std::vector<std::uint32_t> equal_positions(const Mesh& mesh) {
  std::vector<std::uint32_t> to(mesh.vertices.size());
  std::vector<std::uint32_t> slots(std::bit_ceil(2 * mesh.vertices.size() + 1), kNoIndex);  // open addressing
  for (std::uint32_t i = 0; i < to.size(); ++i) {
    Key bits;
    for (std::size_t k = 0; k < 3; ++k)
      bits[k] = std::bit_cast<std::int64_t>(mesh.vertices[i][static_cast<Eigen::Index>(k)] + 0.0);  // -0 is 0
    std::size_t slot = KeyHash{}(bits) & (slots.size() - 1);
    while (slots[slot] != kNoIndex && mesh.vertices[slots[slot]] != mesh.vertices[i])
      slot = (slot + 1) & (slots.size() - 1);
    if (slots[slot] == kNoIndex) slots[slot] = i;
    to[i] = slots[slot];
  }
  return to;
}

/// For each vertex of an open edge the first such vertex within `tolerance`; representatives do not chain.
std::vector<std::uint32_t> close_open_vertices(const Mesh& mesh, double tolerance) {
  std::vector<std::uint32_t> to(mesh.vertices.size());
  for (std::uint32_t i = 0; i < to.size(); ++i) to[i] = i;
  std::vector<char> open(mesh.vertices.size(), 0);
  mesh_detail::for_each_edge(mesh_detail::sorted_edges(mesh), [&](const auto* first, const auto* last) {
    if (last - first == 1) open[first->lo] = open[first->hi] = 1;
  });
  const Eigen::Vector3d origin = mesh.box().lo;
  std::unordered_map<Key, std::vector<std::uint32_t>, KeyHash> grid;
  for (std::uint32_t i = 0; i < to.size(); ++i) {
    if (!open[i]) continue;
    Key cell;
    for (int k = 0; k < 3; ++k)
      cell[static_cast<std::size_t>(k)] = static_cast<std::int64_t>((mesh.vertices[i][k] - origin[k]) / tolerance);
    std::uint32_t best = kNoIndex;
    double best_distance = tolerance;
    for (int n = 0; n < 27; ++n) {
      const auto found = grid.find({cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1});
      if (found == grid.end()) continue;
      for (const std::uint32_t j : found->second) {
        const double d = (mesh.vertices[i] - mesh.vertices[j]).norm();
        if (d < best_distance || (d == best_distance && j < best)) {
          best = j;
          best_distance = d;
        }
      }
    }
    if (best == kNoIndex)
      grid[cell].push_back(i);
    else
      to[i] = best;
  }
  return to;
}

/// Renumbers corners by `to` and drops triangles with two equal corners.
void apply(Mesh& mesh, const std::vector<std::uint32_t>& to, WeldResult& result) {
  for (std::uint32_t i = 0; i < to.size(); ++i) result.merged += to[i] != i;
  std::size_t kept = 0;
  for (Triangle t : mesh.triangles) {
    for (auto& v : t) v = to[v];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
      ++result.degenerate;
    else
      mesh.triangles[kept++] = t;
  }
  mesh.triangles.resize(kept);
}

/// Drops vertices without triangles; `merged` of them are already counted.
std::size_t compact(Mesh& mesh) {
  std::vector<std::uint32_t> index(mesh.vertices.size(), kNoIndex);
  for (const auto& t : mesh.triangles)
    for (const auto v : t) index[v] = 0;
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < index.size(); ++i)
    if (index[i] != kNoIndex) {
      mesh.vertices[next] = mesh.vertices[i];
      index[i] = next++;
    }
  const std::size_t dropped = mesh.vertices.size() - next;
  mesh.vertices.resize(next);
  for (auto& t : mesh.triangles)
    for (auto& v : t) v = index[v];
  return dropped;
}

}  // namespace

WeldResult weld(Mesh& mesh, double tolerance) {
  WeldResult result;
  apply(mesh, equal_positions(mesh), result);
  if (tolerance > 0) {
    // Not below the resolution of coordinates of this size.
    const Aabb box = mesh.box();
    if (!box.empty()) tolerance = std::max(tolerance, 1e-15 * box.size().maxCoeff());
    WeldResult close;
    if (tolerance > 0) apply(mesh, close_open_vertices(mesh, tolerance), close);
    result.merged += close.merged;
    result.degenerate += close.degenerate;
  }
  const std::size_t dropped = compact(mesh);
  result.unused = dropped - std::min(dropped, result.merged);
  return result;
}

DuplicateFaces drop_duplicate_faces(Mesh& mesh) {
  struct Face {
    Triangle corners;  // sorted
    std::uint32_t index;
    bool even;  // orientation: even permutation of the sorted corners
  };
  std::vector<Face> faces;
  faces.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    Triangle t = mesh.triangles[i];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    const bool even = t[1] < t[2];
    if (!even) std::swap(t[1], t[2]);
    faces.push_back({t, i, even});
  }
  faces = mesh_detail::sorted_by_key(
      faces, mesh.vertices.size(), [](const Face& face) { return face.corners[0]; },
      [](const Face& a, const Face& b) { return a.corners != b.corners ? a.corners < b.corners : a.index < b.index; });
  const auto for_each_group = [&](auto&& f) {
    for (std::size_t i = 0; i < faces.size();) {
      std::size_t j = i;
      std::size_t evens = 0;
      while (j < faces.size() && faces[j].corners == faces[i].corners) evens += faces[j++].even;
      f(i, j, evens, j - i - evens);
      i = j;
    }
  };
  std::size_t groups = 0, both = 0;
  for_each_group([&](std::size_t, std::size_t, std::size_t evens, std::size_t odds) {
    ++groups;
    both += evens == odds;
  });
  DuplicateFaces result;
  result.double_sided = both * 2 > groups;
  std::vector<char> keep(mesh.triangles.size(), 0);
  for_each_group([&](std::size_t i, std::size_t j, std::size_t evens, std::size_t odds) {
    if (result.double_sided) {
      keep[faces[i].index] = 1;
      result.repeated += j - i - 1;
    } else if (evens == odds) {
      result.cancelled += j - i;
    } else {
      const bool wanted = evens > odds;
      for (std::size_t k = i; k < j; ++k)
        if (faces[k].even == wanted) {
          keep[faces[k].index] = 1;
          break;
        }
      result.cancelled += 2 * std::min(evens, odds);
      result.repeated += std::max(evens, odds) - std::min(evens, odds) - 1;
    }
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (keep[i]) mesh.triangles[kept++] = mesh.triangles[i];
  mesh.triangles.resize(kept);
  if (result.cancelled) compact(mesh);
  return result;
}

}  // namespace dismantle
