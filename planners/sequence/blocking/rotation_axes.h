/// Candidate axes of rotation of a part: the axes of its round surfaces.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/mesh.h"

namespace dismantle::blocking {

struct RotationAxis {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< frame of the mesh
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit
  double area = 0;                                       ///< of the surface that is round about this axis
};

/// What counts as a round surface.
struct RoundSurface {
  unsigned facets = 9;      ///< per full turn, at least
  double share = 0.02;      ///< of the part's surface, at least
  double tolerance = 0.01;  ///< axes closer than this are merged; units of the mesh
};

/// Up to `most` axes of cylinders in the surface, largest area first. An axis about which the whole surface is round is
/// left out, because rotation about it changes nothing. Neighbouring facets of a cylinder are chords of one circle, so
/// their perpendicular bisectors meet on the axis.
std::vector<RotationAxis> rotation_axes(const Mesh& mesh, std::size_t most, const RoundSurface& round_surface);

}  // namespace dismantle::blocking
