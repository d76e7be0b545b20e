/// Steps that turn the triangles of a file into a closed, outward surface. Each says what it did.
/// No step moves a vertex further than its tolerance, or changes which points are inside a surface that is fine
/// already.
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
  std::size_t unused = 0;      ///< vertices dropped since no triangle uses them
  std::size_t degenerate = 0;  ///< triangles dropped that had two equal corners
  bool any() const { return merged || unused || degenerate; }
};

/// Merges vertices at equal positions, then, when that leaves open edges and tolerance > 0, the vertices of open edges
/// that lie within `tolerance` of each other (so that closed detail is never touched, however small). Drops triangles
/// with two equal corners and unused vertices. Keeps the order of what stays.
DISMANTLE_API WeldResult weld(Mesh& mesh, double tolerance);

/// What drop_duplicate_faces() did.
struct DuplicateFaces {
  std::size_t repeated = 0;   ///< copies dropped of triangles that were there before
  std::size_t cancelled = 0;  ///< triangles dropped in pairs of opposite sense: walls without thickness
  bool double_sided = false;  ///< most triangles come with both senses: one of each was kept
};
/// On welded meshes: leaves at most one triangle on three corners.
DISMANTLE_API DuplicateFaces drop_duplicate_faces(Mesh& mesh);

/// Splits triangles at open edges where a vertex of another open edge lies on them within `tolerance`.
/// Returns the number of triangles split.
DISMANTLE_API std::size_t close_t_junctions(Mesh& mesh, double tolerance);

/// Up to which size holes are filled.
struct HoleLimits {
  double max_area_share = 0.1;  ///< of the mesh's surface area
  std::size_t max_edges = 1000;
  double max_unevenness = 0.05;  ///< distance of the rim from its best plane, share of its extent, to count as flat
  std::size_t max_uneven_edges = 200;  ///< of rims that are not flat
};
/// A hole of a mesh, filled or not.
struct Hole {
  bool filled = false;
  std::size_t edges = 0;
  double area = 0;  ///< of the filling when there is one, else of the rim seen from its best direction
  bool flat = true;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  std::string why_not;  ///< when not filled
};
/// Closes the small loops of open edges: flat ones by a flat polygon, others by the surface of smallest area that is
/// made of triangles of rim vertices. Neighbouring triangles must be oriented alike.
DISMANTLE_API std::vector<Hole> fill_holes(Mesh& mesh, const HoleLimits& limits);

/// What orienting the triangles did.
struct OrientResult {
  std::size_t flipped = 0;    ///< triangles turned
  std::size_t membranes = 0;  ///< triangles dropped: outside or inside of the solid on both sides
  bool one_sided = false;     ///< some connected surface has no two sides (Moebius); left as it was
};
/// Makes every edge-connected surface outward on its own, by following sides of triangles around edges, from a side
/// that sees infinity. Where three or more triangles meet in an edge, triangles that do not separate the inside from
/// the outside are dropped. Open edges count as tight. Closed consistent surfaces of positive volume come back
/// unchanged.
DISMANTLE_API OrientResult orient_outward(Mesh& mesh);

/// What sorting the closed shells of a mesh did.
struct ShellResult {
  std::size_t shells = 0;
  std::size_t voids = 0;         ///< inward shells inside a solid
  std::size_t turned = 0;        ///< shells turned inside out
  std::size_t inner_solids = 0;  ///< outward shells inside a solid: taken as solid, as the file says
};
/// Decides which shells of a closed mesh are solid and which are voids. `trusted`: the file's orientation is
/// consistent, so nested shells keep theirs relative to the outermost one; otherwise nesting parity decides.
/// An outermost shell is always made outward.
DISMANTLE_API ShellResult orient_shells(Mesh& mesh, bool trusted);

}  // namespace dismantle
