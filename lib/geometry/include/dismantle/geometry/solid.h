/// A part as the verifier uses it: closed shells grouped into solids, with precomputed data for sweeps.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "dismantle/geometry/poll.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/mesh.h"
#include "dismantle/pose.h"

namespace dismantle::geometry {

/// One outer shell and the voids within it. A part with overlapping shells is checked solid by solid, since the surface
/// of a shell inside another would make a deep penetration look shallow. Immutable.
///
/// A part whose surface is open is a single `Solid` of walls: sheets that are manifold and oriented alike, which share
/// no vertex. It has no inside that a proof may use, and its thickness is not measured.
struct Solid {
  explicit Solid(const Mesh& m, const Poll& poll = {}, Surface surface = Surface::closed);

  /// A rotation: assembled = frame * local. Everything below is in the local frame, whose axes follow the largest flat
  /// faces, so that boxes fit tightly however the part was turned in the input.
  Pose frame;
  Mesh mesh;
  TriangleBvh bvh;
  Aabb box;
  bool open = false;  ///< walls
  std::vector<Eigen::Vector3d> normals;  ///< by triangle: unit, outward; zero for a triangle without area
  std::vector<Eigen::Vector3d> inward;   ///< by vertex: unit, into every face around it; zero if there is none
  /// By triangle: length of an inward ray to the opposite side, the minimum of four samples; infinity beyond the reach
  /// of measure_thickness(). A triangle that shares a corner counts only if it faces almost the opposite way.
  std::vector<double> thickness;
  std::vector<double> vertex_thickness;       ///< minimum of the adjacent triangles
  std::vector<std::uint32_t> shell_of;        ///< by triangle: its shell, or its sheet
  std::vector<std::uint32_t> shell_vertices;  ///< vertices of all shells, shell by shell
  std::vector<std::uint32_t> shell_begin;     ///< first vertex of each shell; one entry more than shells

  /// Measures thickness up to `reach`; before this call it is infinite everywhere.
  void measure_thickness(double reach, const Poll& poll = {});
};

/// The walls of an open mesh as one element; else by shells: triangles with common edges form a shell. An inward shell is a void of the smallest solid around it; without such a
/// solid it is treated as a solid with reversed orientation.
std::vector<Solid> split_into_solids(const Mesh& mesh, const Poll& poll = {});

}  // namespace dismantle::geometry
