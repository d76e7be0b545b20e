/// Circles within a solid, and candidate axes for them.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"

namespace dismantle::immobility {

/// A circle within a solid, everywhere deeper below its surface than a given depth. Assembled frame.
struct InteriorCircle {
  Eigen::Vector3d center = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::UnitZ();
  double radius = 0;
};

/// The point of the circle at an angle from a fixed direction; rad.
Eigen::Vector3d point_on(const InteriorCircle& circle, double angle);

/// True if the whole circle is proved deeper in the solid than `depth` (> 0). Arcs are halved, since the depth of a
/// point changes no faster than the point moves; false if arcs of a tenth of `depth` do not suffice.
bool is_deep(const Solid& solid, const InteriorCircle& circle, double depth);
/// The same for 24 points of the circle only: a quick test before is_deep().
bool samples_are_deep(const Solid& solid, const InteriorCircle& circle, double depth);

/// Axes about which a solid may be round: its principal axes of inertia, and the normals of its largest flat faces. In
/// its frame.
struct SymmetryAxes {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< centroid of the surface
  std::vector<Eigen::Vector3d> all;                  ///< unit
};
SymmetryAxes symmetry_axes_of(const Solid& solid);

}  // namespace dismantle::immobility
