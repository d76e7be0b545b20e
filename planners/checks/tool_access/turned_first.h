/// Parts that can be turned out of the way of a tool: wheels, discs, drums.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "dismantle/mesh.h"
#include "dismantle/pose.h"

namespace dismantle::checks {

/// An axis of a part, in the frame of its mesh.
struct TurningAxis {
  Eigen::Vector3d point, direction;  ///< `direction`: unit
};

/// The axis about which the outline of the part is round, whatever holes and spokes it has. None: it has no such axis.
std::optional<TurningAxis> turning_axis(const Mesh& mesh);

/// A turn about the axis by `angle`, rad.
Pose turned_about(const TurningAxis& axis, double angle);

}  // namespace dismantle::checks
