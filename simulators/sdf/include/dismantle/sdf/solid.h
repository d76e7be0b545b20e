/// A part split into solids: closed surfaces whose nearest feature decides inside or outside.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/geometry/poll.h"
#include "dismantle/mesh.h"

namespace dismantle::sdf {

/// One outer shell together with the voids inside it. A part with several, possibly overlapping shells (inserts, unions
/// not merged in CAD) becomes several solids; the part is their union and its distance is their smallest.
struct Solid {
  Mesh mesh;
  bool open = false;  ///< walls: the generalised winding number decides inside or outside
  // Angle-weighted pseudo-normals (Baerentzen & Aanaes 2005), not normalised for vertices and edges:
  std::vector<Eigen::Vector3d> face_normal;                 ///< unit, per triangle
  std::vector<std::array<Eigen::Vector3d, 3>> edge_normal;  ///< per triangle, edge k joins corners k and k+1
  std::vector<Eigen::Vector3d> vertex_normal;               ///< per vertex
};

/// Splits into connected shells; a shell of negative volume is a void of the smallest outer shell around it. `mesh`
/// must be closed and oriented.
std::vector<Solid> split_solids(const Mesh& mesh, const geometry::Poll& poll = {});

/// All of an open mesh.
Solid walls(const Mesh& mesh, const geometry::Poll& poll = {});

}  // namespace dismantle::sdf
