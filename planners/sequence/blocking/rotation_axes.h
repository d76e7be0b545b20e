/// Lines about which a part may turn: the axes of its round surfaces.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/mesh.h"

namespace dismantle::blocking {

struct RotationAxis {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< frame of the mesh
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit
  double area = 0;                                       ///< of the surface that is round about it
};

/// What counts as a round surface.
struct RoundSurface {
  unsigned facets = 9;      ///< per full turn, at least
  double share = 0.02;      ///< of the part's surface, at least
  double tolerance = 0.01;  ///< distance between axes that are one; units of the mesh
};

/// Axes of cylinders in the surface, those of most area first. None about which all of the surface is round: turning
/// about it changes nothing. Neighbouring facets of a cylinder are chords of one circle, so the lines that halve them
/// meet on the axis.
std::vector<RotationAxis> rotation_axes(const Mesh& mesh, std::size_t most, const RoundSurface& round_surface);

}  // namespace dismantle::blocking
