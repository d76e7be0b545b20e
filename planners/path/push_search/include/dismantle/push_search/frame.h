/// Axes and extents that rotate with the assembly.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dismantle/simulator.h"

namespace dismantle::push {

/// Columns: three orthonormal axes (right-handed, world frame) that depend on the parts only. The first is the normal
/// with the most area on the moving parts. The second is the one with the most area among the normals perpendicular to
/// it, of the moving parts or else of the fixed parts; if there is none, it points to the vertex furthest from the
/// first axis. A rotated assembly has rotated axes, up to their signs and up to the order of axes with equal area.
///
/// Normals closer than `facet_angle` (rad) belong to one axis; normals are perpendicular to within the same angle.
Eigen::Matrix3d own_axes(const Assembly& assembly, const Scene& scene, double facet_angle);

/// Bounding boxes of the moving and of the fixed parts along given axes.
class Extents {
 public:
  Extents(const Assembly& assembly, const Scene& scene, const Eigen::Matrix3d& axes);
  /// Distance along `direction` (world, unit) after which the boxes are disjoint; infinite for a zero direction.
  double exit_distance(const Eigen::Vector3d& direction) const;
  /// Sum of the diagonals of both boxes: a translation of this length separates boxes that overlap.
  double longest_exit() const;

 private:
  Eigen::Matrix3d axes_;
  Aabb moving_, fixed_;
};

}  // namespace dismantle::push
