/// A point that locks two solids into each other.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/pose.h"

namespace dismantle::immobility {

struct DeepPoint {
  Eigen::Vector3d point;  ///< in the frame of the poses
  double depth = 0;       ///< below the surface of the first solid
};

/// A point that lies in both solids, more than `limit` (> 0) below the surface of `a`. Returns nullopt if none was
/// found with `most_cubes` divisions. Branch and bound over cubes: the depth of a point changes no faster than the
/// point moves.
///
/// Such a point locks the solids. Fix it to `a`. When the solids are apart, it is outside `b`, so on the way it passes
/// through the surface of `b`. At that moment the surface of `b` is more than `limit` deep in `a`.
std::optional<DeepPoint> deep_common_point(const Solid& a, const Pose& pose_a, const Solid& b, const Pose& pose_b,
                                           double limit, std::uint64_t most_cubes = 1000);

}  // namespace dismantle::immobility
