/// The arrangement of great circles on the sphere of directions: along all directions of one of its cells the same
/// planar contacts let parts go (Wilson and Latombe 1994, section 4).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/assembly.h"

namespace dismantle::ndbg {

/// One direction of each cell, unit vectors. The opposite of each is among them, too: cells come in opposite pairs.
struct Arrangement {
  std::vector<Eigen::Vector3d> vertices;  ///< where circles cross
  std::vector<Eigen::Vector3d> arcs;      ///< one on each arc between two vertices
  std::vector<Eigen::Vector3d> faces;     ///< one within each face, in the middle of its corners
};

/// Of the circles that are perpendicular to `normals`: unit vectors, no two parallel. With fewer than three that are
/// linearly independent there is no such arrangement: all lists are empty.
Arrangement arrangement_of(const std::vector<Eigen::Vector3d>& normals);

/// Normals of the flat faces of all parts, those with most surface first, at most `most`; then the axes of the
/// assembly, as far as it takes for three that are linearly independent.
std::vector<Eigen::Vector3d> circle_normals(const Assembly& assembly, std::size_t most);

}  // namespace dismantle::ndbg
