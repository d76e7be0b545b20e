/// Axes and extents that turn with the assembly.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/simulator.h"

namespace dismantle::push {

/// Columns: three orthonormal axes (right-handed, world) told by the parts alone: the normal of most of the surface of
/// the moving parts, then the one of most surface among those square to it, of the moving parts or else of those that
/// stay fixed. Round parts without a second one: towards the point furthest from the first axis. Turned input gives
/// turned axes, up to their signs, and the order of axes that have equally much surface.
///
/// Normals closer than `facet_angle` (rad) belong to one axis, and two are square to each other within it.
Eigen::Matrix3d own_axes(const Assembly& assembly, const Scene& scene, double facet_angle);

/// Bounding boxes of the moving and of the fixed parts along given axes.
class Extents {
 public:
  Extents(const Assembly& assembly, const Scene& scene, const Eigen::Matrix3d& axes);
  /// How far the moving parts have to go along `direction` (world, unit) until the boxes are apart; infinite for none.
  double way_out(const Eigen::Vector3d& direction) const;
  /// The diagonals of both: parts whose boxes overlap are separated by a translation of this length.
  double longest_way_out() const;

 private:
  Eigen::Matrix3d axes_;
  Aabb moving_, fixed_;
};

}  // namespace dismantle::push
