#include "dismantle/sdf/solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>

#include "dismantle/geometry/disjoint_sets.h"
#include "dismantle/geometry/mass_properties.h"
#include "dismantle/geometry/mesh_edges.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::sdf {
namespace {

double corner_angle(const Eigen::Vector3d& at, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d u = b - at, v = c - at;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

Solid with_normals(Mesh mesh, const geometry::Poll& poll) {
  poll.before(mesh.triangles.size());
  Solid solid;
  const std::size_t n = mesh.triangles.size();
  solid.face_normal.resize(n);
  solid.edge_normal.resize(n);
  solid.vertex_normal.assign(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (std::size_t t = 0; t < n; ++t) {
    const auto& tri = mesh.triangles[t];
    const auto &a = mesh.vertex(t, 0), &b = mesh.vertex(t, 1), &c = mesh.vertex(t, 2);
    const Eigen::Vector3d cross = (b - a).cross(c - a);
    const double length = cross.norm();
    solid.face_normal[t] = length > 0 ? Eigen::Vector3d(cross / length) : Eigen::Vector3d::Zero();
    solid.vertex_normal[tri[0]] += corner_angle(a, b, c) * solid.face_normal[t];
    solid.vertex_normal[tri[1]] += corner_angle(b, c, a) * solid.face_normal[t];
    solid.vertex_normal[tri[2]] += corner_angle(c, a, b) * solid.face_normal[t];
  }
  poll.before(mesh.triangles.size());
  mesh_detail::for_each_edge(mesh_detail::sorted_edges(mesh), [&](const auto* first, const auto* last) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto* e = first; e < last; ++e) sum += solid.face_normal[e->triangle];
    for (const auto* e = first; e < last; ++e) solid.edge_normal[e->triangle][e->corner] = sum;
  });
  solid.mesh = std::move(mesh);
  return solid;
}

/// Connected components over shared vertices, in order of their first triangle.
std::vector<Mesh> shells_of(const Mesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 1; k < 3; ++k) sets.join(t[0], t[k]);
  std::vector<int> shell_of_root(mesh.vertices.size(), -1);
  std::vector<std::uint32_t> local(mesh.vertices.size(), 0xffffffffu);
  std::vector<Mesh> shells;
  for (const auto& t : mesh.triangles) {
    int& shell = shell_of_root[sets.root(t[0])];
    if (shell < 0) {
      shell = static_cast<int>(shells.size());
      shells.emplace_back();
    }
    Mesh& out = shells[static_cast<std::size_t>(shell)];
    Triangle mapped{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (local[t[k]] == 0xffffffffu) {
        local[t[k]] = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[t[k]]);
      }
      mapped[k] = local[t[k]];
    }
    out.triangles.push_back(mapped);
  }
  return shells;
}

void append(Mesh& to, const Mesh& from) {
  const auto offset = static_cast<std::uint32_t>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
  for (const auto& t : from.triangles) to.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
}

}  // namespace

Solid walls(const Mesh& mesh, const geometry::Poll& poll) {
  Solid solid = with_normals(mesh, poll);
  solid.open = true;
  return solid;
}

std::vector<Solid> split_solids(const Mesh& mesh, const geometry::Poll& poll) {
  std::vector<Mesh> shells = shells_of(mesh);
  if (shells.size() == 1) {
    std::vector<Solid> one;
    one.push_back(with_normals(mesh, poll));
    return one;
  }
  std::vector<double> volume;
  for (const auto& s : shells) volume.push_back(mass_properties(s).volume);
  std::vector<Mesh> solids;
  std::vector<int> solid_of(shells.size(), -1);
  for (std::size_t i = 0; i < shells.size(); ++i)
    if (volume[i] > 0) {
      solid_of[i] = static_cast<int>(solids.size());
      solids.push_back(shells[i]);
    }
  std::vector<std::unique_ptr<TriangleBvh>> bvh(shells.size());
  for (std::size_t v = 0; v < shells.size(); ++v) {
    if (volume[v] > 0) continue;
    int best = -1;
    for (std::size_t i = 0; i < shells.size(); ++i) {
      if (solid_of[i] < 0 || !shells[i].box().contains(shells[v].vertices.front())) continue;
      if (!bvh[i]) bvh[i] = std::make_unique<TriangleBvh>(shells[i]);
      if (!bvh[i]->inside(shells[v].vertices.front())) continue;
      if (best < 0 || volume[i] < volume[static_cast<std::size_t>(best)]) best = static_cast<int>(i);
    }
    if (best >= 0) append(solids[static_cast<std::size_t>(solid_of[static_cast<std::size_t>(best)])], shells[v]);
  }
  std::vector<Solid> result;
  for (auto& s : solids) result.push_back(with_normals(std::move(s), poll));
  return result;
}

}  // namespace dismantle::sdf
