#include "mesh/ring_holes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "dismantle/geometry/mesh_edges.h"
#include "dismantle/geometry/mesh_measure.h"
#include "mesh/cross2.h"

namespace dismantle::mesh_detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Distances this near count as equal, so that a part that is turned gets the same triangles.
constexpr double kEqualDistance = 1e-9;
constexpr double kInOnePlane = 1e-3;  // of the extent of the rim: rounding of coordinates in files

/// A rim and its plane.
struct FlatRim {
  Vector3d center = Vector3d::Zero(), normal = Vector3d::Zero();
  double area = 0, extent = 0;
  std::uint32_t shell = 0;

  FlatRim(const Mesh& mesh, const Rim& rim, std::uint32_t of_shell) : shell(of_shell) {
    Aabb box;
    for (const auto v : rim) {
      center += mesh.vertices[v] / static_cast<double>(rim.size());
      box.extend(mesh.vertices[v]);
    }
    for (std::size_t i = 0; i < rim.size(); ++i)
      normal += (mesh.vertices[rim[i]] - center).cross(mesh.vertices[rim[(i + 1) % rim.size()]] - center) / 2;
    area = normal.norm();
    if (area > 0) normal /= area;
    extent = box.size().norm();
  }

  bool holds(const Mesh& mesh, const Rim& rim, double within) const {
    return std::all_of(rim.begin(), rim.end(),
                       [&](auto v) { return std::abs(normal.dot(mesh.vertices[v] - center)) <= within; });
  }
};

/// Is the point inside the rim, both seen along the normal?
bool encloses(const Mesh& mesh, const Rim& rim, const Vector3d& normal, const Vector3d& point) {
  const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  const auto seen = [&](std::uint32_t id) {
    const Vector3d d = mesh.vertices[id] - point;
    return Vector2d(u.dot(d), v.dot(d));
  };
  bool inside = false;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vector2d a = seen(rim[i]), b = seen(rim[(i + 1) % rim.size()]);
    if ((a.y() > 0) != (b.y() > 0) && (cross2(a, b) > 0) == (b.y() > a.y())) inside = !inside;
  }
  return inside;
}

/// The outer rim with a bridge to the inner one: from its k-th vertex around the inner rim from the i-th, and back.
Rim bridged(const Rim& outer, std::size_t k, const Rim& inner, std::size_t i) {
  Rim joined(outer.begin(), outer.begin() + static_cast<std::ptrdiff_t>(k) + 1);
  for (std::size_t n = 0; n <= inner.size(); ++n) joined.push_back(inner[(i + n) % inner.size()]);
  joined.insert(joined.end(), outer.begin() + static_cast<std::ptrdiff_t>(k), outer.end());
  return joined;
}

/// Joins the nearest of the inner rims first, so that no bridge crosses another one.
Rim with_islands(const Mesh& mesh, Rim outer, std::vector<Rim> islands) {
  while (!islands.empty()) {
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t island = 0, from = 0, to = 0;
    for (std::size_t n = 0; n < islands.size(); ++n)
      for (std::size_t k = 0; k < outer.size(); ++k)
        for (std::size_t i = 0; i < islands[n].size(); ++i) {
          const double d = (mesh.vertices[outer[k]] - mesh.vertices[islands[n][i]]).squaredNorm();
          if (d < (1 - kEqualDistance) * nearest) nearest = d, island = n, from = k, to = i;
        }
    outer = bridged(outer, from, islands[island], to);
    islands.erase(islands.begin() + static_cast<std::ptrdiff_t>(island));
  }
  return outer;
}

}  // namespace

std::vector<Rim> join_ring_holes(const Mesh& mesh, std::vector<Rim> rims) {
  if (rims.size() < 2) return rims;
  std::size_t shells = 0;
  const std::vector<std::uint32_t> shell_of = shells_of(mesh, shells);
  // By open edge, as a filling has it: vertices may belong to several shells.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> shell_at;
  for_each_edge(sorted_edges(mesh), [&](const auto* first, const auto* last) {
    if (last - first == 1)
      shell_at[first->forward ? std::pair(first->hi, first->lo) : std::pair(first->lo, first->hi)] =
          shell_of[first->triangle];
  });
  std::vector<FlatRim> flat;
  for (const Rim& rim : rims) flat.emplace_back(mesh, rim, shell_at.at({rim[0], rim[1]}));

  const auto is_in = [&](std::size_t inner, std::size_t outer) {
    const FlatRim &a = flat[inner], &b = flat[outer];
    if (inner == outer || a.shell != b.shell || !(a.area < b.area) || rims[inner].size() < 3) return false;
    const double within = kInOnePlane * a.extent;
    return a.normal.dot(b.normal) < 0 && b.holds(mesh, rims[inner], within) &&
           b.holds(mesh, rims[outer], kInOnePlane * b.extent) &&
           encloses(mesh, rims[outer], b.normal, mesh.vertices[rims[inner].front()]);
  };
  std::vector<std::vector<Rim>> islands(rims.size());
  std::vector<bool> is_island(rims.size(), false);
  for (std::size_t inner = 0; inner < rims.size(); ++inner) {
    std::size_t around = rims.size();
    for (std::size_t outer = 0; outer < rims.size(); ++outer)
      if (is_in(inner, outer) && (around == rims.size() || flat[outer].area < flat[around].area)) around = outer;
    if (around == rims.size()) continue;
    islands[around].push_back(rims[inner]);
    is_island[inner] = true;
  }
  std::vector<Rim> joined;
  for (std::size_t k = 0; k < rims.size(); ++k)
    if (!is_island[k]) joined.push_back(with_islands(mesh, std::move(rims[k]), std::move(islands[k])));
  return joined;
}

}  // namespace dismantle::mesh_detail
