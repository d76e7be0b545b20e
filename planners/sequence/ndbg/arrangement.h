/// The arrangement of great circles on the sphere of directions. All directions of one cell break the same planar
/// contacts (Wilson and Latombe 1994, section 4).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/assembly.h"

namespace dismantle::ndbg {

/// One direction of each cell, unit vectors. Cells come in opposite pairs, so the opposite of each is contained, too.
struct Arrangement {
  std::vector<Eigen::Vector3d> vertices;  ///< where circles cross
  std::vector<Eigen::Vector3d> arcs;      ///< one on each arc between two vertices
  std::vector<Eigen::Vector3d> faces;     ///< one within each face, in the middle of its corners
};

/// The arrangement of the circles that are perpendicular to `normals`: unit vectors, no two parallel. All lists are
/// empty when fewer than three normals are linearly independent.
Arrangement arrangement_of(const std::vector<Eigen::Vector3d>& normals);

/// Up to `most` normals of the flat faces of all parts, those with the most surface area first. Coordinate axes are
/// added until three are linearly independent.
std::vector<Eigen::Vector3d> circle_normals(const Assembly& assembly, std::size_t most);

}  // namespace dismantle::ndbg
