/// A part as the verifier uses it: closed shells grouped into solids, with all that sweeps need of each, built once.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "dismantle/geometry/poll.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/mesh.h"
#include "dismantle/pose.h"

namespace dismantle::geometry {

/// One outer shell and the voids within it. A part whose shells overlap is checked solid by solid: the surface of
/// one shell inside another must not make a deep penetration look shallow. Immutable.
struct Solid {
  explicit Solid(const Mesh& m, const Poll& poll = {});

  /// A rotation: assembled = frame * local. Everything below is in the local frame, whose axes follow the largest flat
  /// faces, so that boxes fit tightly however the part was turned in the input.
  Pose frame;
  Mesh mesh;
  TriangleBvh bvh;
  Aabb box;
  std::vector<Eigen::Vector3d> normals;  ///< by triangle: unit, outward; zero for a triangle without area
  std::vector<Eigen::Vector3d> inward;   ///< by vertex: unit, into every face around it; zero where there is none
  /// By triangle: length of an inward ray to the opposite side, the least of four samples; infinity beyond the reach
  /// asked for. A neighbour that shares a corner counts only when it faces almost the opposite way.
  std::vector<double> thickness;
  std::vector<double> vertex_thickness;       ///< least of the triangles around
  std::vector<std::uint32_t> shell_vertices;  ///< for each shell, all its vertices, ...
  std::vector<std::uint32_t> shell_begin;     ///< ... which begin here; one entry more than shells

  /// Fills thickness up to `reach`; until then it is infinite everywhere.
  void measure_thickness(double reach, const Poll& poll = {});
};

/// Shells are joined by common edges. A shell turned inside out is a void of the smallest solid around it; if there
/// is none, it is taken for a solid that was wound the wrong way.
std::vector<Solid> split_into_solids(const Mesh& mesh, const Poll& poll = {});

}  // namespace dismantle::geometry
