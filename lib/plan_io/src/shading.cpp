#include "dismantle/plan_io/shading.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "dismantle/geometry/disjoint_sets.h"

namespace dismantle {
namespace {

struct HalfEdge {
  std::uint32_t lo, hi;        // vertices
  std::uint32_t at_lo, at_hi;  // corners of the triangle there
};

double corner_angle(const Mesh& mesh, std::uint32_t triangle, int corner) {
  const Eigen::Vector3d& p = mesh.vertex(triangle, corner);
  const Eigen::Vector3d a = mesh.vertex(triangle, (corner + 1) % 3) - p,
                        b = mesh.vertex(triangle, (corner + 2) % 3) - p;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

ShadedMesh shade(const Mesh& mesh, double crease_angle) {
  std::vector<std::uint32_t> kept;
  std::vector<Eigen::Vector3d> face_normals;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d n = (mesh.vertex(t, 1) - mesh.vertex(t, 0)).cross(mesh.vertex(t, 2) - mesh.vertex(t, 0));
    const double area = n.norm();
    if (!(area > 0) || !std::isfinite(area)) continue;
    kept.push_back(t);
    face_normals.push_back(n / area);
  }

  std::vector<HalfEdge> edges;
  edges.reserve(3 * kept.size());
  for (std::uint32_t k = 0; k < kept.size(); ++k)
    for (std::uint32_t c = 0; c < 3; ++c) {
      const std::uint32_t a = mesh.triangles[kept[k]][c], b = mesh.triangles[kept[k]][(c + 1) % 3];
      const std::uint32_t corner_a = 3 * k + c, corner_b = 3 * k + (c + 1) % 3;
      edges.push_back(a < b ? HalfEdge{a, b, corner_a, corner_b} : HalfEdge{b, a, corner_b, corner_a});
    }
  std::ranges::sort(edges, {}, [](const HalfEdge& e) { return std::array{e.lo, e.hi, e.at_lo}; });

  DisjointSets sets(3 * kept.size());
  const double smooth = std::cos(crease_angle);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    while (end < edges.size() && edges[end].lo == edges[i].lo && edges[end].hi == edges[i].hi) ++end;
    // Where more than two triangles meet, surfaces merely touch.
    if (end == i + 2 && face_normals[edges[i].at_lo / 3].dot(face_normals[edges[i + 1].at_lo / 3]) > smooth) {
      sets.join(edges[i].at_lo, edges[i + 1].at_lo);
      sets.join(edges[i].at_hi, edges[i + 1].at_hi);
    }
    i = end;
  }

  std::vector<Eigen::Vector3d> normals(3 * kept.size(), Eigen::Vector3d::Zero());
  for (std::uint32_t k = 0; k < kept.size(); ++k)
    for (std::uint32_t c = 0; c < 3; ++c)
      normals[sets.root(3 * k + c)] += corner_angle(mesh, kept[k], static_cast<int>(c)) * face_normals[k];

  ShadedMesh out;
  out.indices.reserve(3 * kept.size());
  std::vector<std::uint32_t> index_of(3 * kept.size(), 0xffffffffu);
  for (std::uint32_t k = 0; k < kept.size(); ++k)
    for (std::uint32_t c = 0; c < 3; ++c) {
      const std::uint32_t root = sets.root(3 * k + c);
      if (index_of[root] == 0xffffffffu) {
        index_of[root] = static_cast<std::uint32_t>(out.positions.size());
        const double length = normals[root].norm();
        const Eigen::Vector3d n = length > 1e-6 ? Eigen::Vector3d(normals[root] / length) : face_normals[k];
        out.positions.push_back(mesh.vertex(kept[k], static_cast<int>(c)).cast<float>());
        out.normals.push_back(n.cast<float>().normalized());
      }
      out.indices.push_back(index_of[root]);
    }
  return out;
}

}  // namespace dismantle
