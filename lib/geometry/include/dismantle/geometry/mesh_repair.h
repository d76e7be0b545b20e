/// Steps that turn the triangles of a file into a closed, outward surface. Each step reports what it did. No step moves
/// a vertex further than its tolerance, or changes the inside of a surface that is already valid.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/mesh.h"

namespace dismantle {

/// What welding the vertices did.
struct WeldResult {
  std::size_t merged = 0;      ///< vertices merged into equal or close ones
  std::size_t unused = 0;      ///< vertices dropped because no triangle uses them
  std::size_t degenerate = 0;  ///< triangles dropped that had two equal corners
  bool any() const { return merged || unused || degenerate; }
};

/// Merges vertices at equal positions. If open edges remain and tolerance > 0, it then merges vertices of open edges
/// that lie within `tolerance` of each other; closed detail is never changed, however small. Drops triangles with two
/// equal corners and unused vertices. Keeps the order of the rest.
DISMANTLE_API WeldResult weld(Mesh& mesh, double tolerance);

/// What drop_duplicate_faces() did.
struct DuplicateFaces {
  std::size_t repeated = 0;   ///< dropped copies of earlier triangles
  std::size_t cancelled = 0;  ///< triangles dropped in pairs of opposite orientation: walls without thickness
  bool double_sided = false;  ///< most triangles exist in both orientations: one of each pair was kept
};
/// Leaves at most one triangle per set of three corners. The mesh must be welded.
DISMANTLE_API DuplicateFaces drop_duplicate_faces(Mesh& mesh);

/// Splits triangles at open edges where a vertex of another open edge lies on them within `tolerance`.
/// Returns the number of triangles split.
DISMANTLE_API std::size_t close_t_junctions(Mesh& mesh, double tolerance);

/// Largest size of holes that are filled.
struct HoleLimits {
  double max_area_share = 0.1;  ///< of the mesh's surface area
  std::size_t max_edges = 1000;
  double max_unevenness = 0.05;        ///< a flat rim: largest distance from its best plane, as a share of its extent
  std::size_t max_uneven_edges = 200;  ///< of rims that are not flat
};
/// A hole of a mesh, filled or not.
struct Hole {
  bool filled = false;
  bool slit = false;  ///< filled by a vertex more in the triangle at its longest edge: a T-junction that is not exact
  std::size_t edges = 0;
  double area = 0;  ///< of the filling if there is one, else of the rim projected on its best plane
  bool flat = true;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  std::string why_not;  ///< when not filled
};
/// Fills small loops of open edges: a flat loop with a flat polygon, any other loop with the triangulation of its rim
/// vertices that has the smallest area. A narrow hole whose filling would lie on its neighbours, back to back, is
/// closed by splitting the triangle at its longest edge. Neighbouring triangles must be oriented consistently.
DISMANTLE_API std::vector<Hole> fill_holes(Mesh& mesh, const HoleLimits& limits);

/// What orienting the triangles did.
struct OrientResult {
  std::size_t flipped = 0;    ///< triangles whose orientation was reversed
  std::size_t membranes = 0;  ///< triangles dropped: outside the solid, or inside it, on both sides
  bool one_sided = false;     ///< a connected surface has only one side (Moebius); it is unchanged
};
/// Orients every edge-connected surface outward by itself, following the sides of triangles around edges from a side
/// that is visible from infinity. Where three or more triangles meet in an edge, triangles that do not separate inside
/// from outside are dropped. Open edges are treated as closed. Closed, consistent surfaces of positive volume do not
/// change.
DISMANTLE_API OrientResult orient_outward(Mesh& mesh);

/// What sorting the closed shells of a mesh did.
struct ShellResult {
  std::size_t shells = 0;
  std::size_t voids = 0;         ///< inward shells inside a solid
  std::size_t turned = 0;        ///< shells whose orientation was reversed
  std::size_t inner_solids = 0;  ///< outward shells inside a solid: kept as solids, as in the file
};
/// Decides which shells of a closed mesh are solid and which are voids. `trusted`: the file's orientation is
/// consistent, so nested shells keep theirs relative to the outermost one; otherwise nesting parity decides.
/// An outermost shell is always made outward.
DISMANTLE_API ShellResult orient_shells(Mesh& mesh, bool trusted);

}  // namespace dismantle
