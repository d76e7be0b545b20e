/// How far a part has to be turned until it looks the same again.
#pragma once

#include <Eigen/Core>

#include "dismantle/mesh.h"

namespace dismantle::checks {

/// Angles in degrees, as Boothroyd and Dewhurst define them.
struct Symmetry {
  double alpha = 360;  ///< about an axis across the direction of insertion: 360, 180, or 0 for a ball
  double beta = 360;   ///< about the direction of insertion: 360 divided by 1, 2, 3, 4, 5, 6 or 8, or 0
};

/// By up to 200 vertices, turned about the middle of the surface, within 1 % of the size of the part. `axis`: unit, in
/// the frame of the mesh.
Symmetry symmetry_of(const Mesh& mesh, const Eigen::Vector3d& axis);

}  // namespace dismantle::checks
