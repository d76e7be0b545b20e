#include <map>

#include "dismantle/geometry/disjoint_sets.h"
#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/mesh_edges.h"
#include "dismantle/geometry/mesh_measure.h"

namespace dismantle {

double signed_volume(const Mesh& mesh) {
  if (mesh.empty()) return 0;
  const Eigen::Vector3d c = mesh.box().center();
  double six = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    six += (mesh.vertex(t, 0) - c).dot((mesh.vertex(t, 1) - c).cross(mesh.vertex(t, 2) - c));
  return six / 6;
}

double surface_area(const Mesh& mesh) {
  double twice = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) twice += geometry::area_vector(mesh, t).norm();
  return twice / 2;
}

double longest_edge(const Mesh& mesh) {
  double longest = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c) longest = std::max(longest, (mesh.vertex(t, c) - mesh.vertex(t, (c + 1) % 3)).norm());
  return longest;
}

EdgeUse edge_use(const Mesh& mesh) {
  EdgeUse use;
  bool placed_open = false, placed = false;
  mesh_detail::for_each_edge(mesh_detail::sorted_edges(mesh),
                             [&](const mesh_detail::EdgeRef* first, const mesh_detail::EdgeRef* last) {
                               const auto n = last - first;
                               const auto forward = std::count_if(first, last, [](const auto& e) { return e.forward; });
                               const bool open = n == 1, uneven = !open && 2 * forward != n;
                               use.open += open;
                               use.crowded += n > 2;
                               use.inconsistent += uneven;
                               if ((open && !placed_open) || (uneven && !placed)) {
                                 use.where = 0.5 * (mesh.vertices[first->lo] + mesh.vertices[first->hi]);
                                 placed = true;
                                 placed_open = placed_open || open;
                               }
                             });
  return use;
}

std::vector<std::uint32_t> shells_of(const Mesh& mesh, std::size_t& count) {
  DisjointSets sets(mesh.triangles.size());
  mesh_detail::for_each_edge(mesh_detail::sorted_edges(mesh),
                             [&](const mesh_detail::EdgeRef* first, const mesh_detail::EdgeRef* last) {
                               for (const auto* e = first + 1; e < last; ++e) sets.join(first->triangle, e->triangle);
                             });
  std::vector<std::uint32_t> shell(mesh.triangles.size());
  std::uint32_t next = 0;
  for (std::uint32_t t = 0; t < shell.size(); ++t) {
    const std::uint32_t root = sets.root(t);  // root <= t: already numbered unless it is t
    shell[t] = root == t ? next++ : shell[root];
  }
  count = next;
  return shell;
}

}  // namespace dismantle
