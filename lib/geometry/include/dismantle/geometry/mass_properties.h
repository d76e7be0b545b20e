/// Volume, centre of mass and inertia of a closed mesh.
#pragma once

#include <Eigen/Core>

#include "dismantle/export.h"
#include "dismantle/mesh.h"

namespace dismantle {

/// Of density 1.
struct MassProperties {
  double volume = 0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about `center`, mesh axes
};
/// By the divergence theorem; exact. `mesh` must be closed and oriented. If the volume is not positive, `center` is
/// that of the box and `inertia` is zero.
DISMANTLE_API MassProperties mass_properties(const Mesh& mesh);

}  // namespace dismantle
