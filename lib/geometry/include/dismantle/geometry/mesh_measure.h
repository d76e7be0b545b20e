/// Facts about a mesh that need no repair: closed or not, shells, volume, thickness, self-crossings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/mesh.h"

namespace dismantle {

/// Enclosed volume by the divergence theorem, about the centre of the box; negative when inside out.
/// Meaningful only for closed meshes. Shells add up, voids (inward shells) subtract.
DISMANTLE_API double signed_volume(const Mesh& mesh);
/// Sum of the areas of all triangles.
DISMANTLE_API double surface_area(const Mesh& mesh);
DISMANTLE_API double longest_edge(const Mesh& mesh);  ///< 0 for an empty mesh

/// How the edges of a mesh are used. Closed = each directed edge is matched by its opposite.
struct EdgeUse {
  std::size_t open = 0;                             ///< undirected edges with one triangle
  std::size_t crowded = 0;                          ///< with three or more triangles
  std::size_t inconsistent = 0;                     ///< with two or more, not equally many in both directions
  Eigen::Vector3d where = Eigen::Vector3d::Zero();  ///< middle of the first open (else inconsistent) edge
  bool closed() const { return open == 0 && inconsistent == 0; }
};
/// Counts how triangles use the edges of a mesh.
DISMANTLE_API EdgeUse edge_use(const Mesh& mesh);

/// Shell of each triangle: connected through shared edges; numbered by first triangle. The mesh must be welded.
DISMANTLE_API std::vector<std::uint32_t> shells_of(const Mesh& mesh, std::size_t& count);

/// Edge lengths of the smallest oriented box found among the directions of the mesh's own faces and its principal
/// axes, ascending. Exact for boxes and prisms, an upper bound of the smallest box otherwise.
DISMANTLE_API Eigen::Vector3d oriented_box(const Mesh& mesh);

/// Pairs of triangles that share no vertex and cross properly (not just touch), at most `limit` of them.
/// Tests every triangle up to `max_tested`, else an evenly spread subset of that many. Ends after a number of pairs in
/// proportion to the triangles: a mesh of slivers may be looked at in part.
DISMANTLE_API std::vector<std::pair<std::uint32_t, std::uint32_t>> self_crossings(const Mesh& mesh, std::size_t limit,
                                                                                  std::size_t max_tested = 200'000);

/// Cuts a simple polygon (concave allowed, nearly planar) into triangles of its corners, n - 2 of them, same turning
/// sense. Empty when its projection on the best plane crosses itself or has no area.
DISMANTLE_API std::vector<Triangle> triangulate_polygon(std::span<const Eigen::Vector3d> corners);

}  // namespace dismantle
