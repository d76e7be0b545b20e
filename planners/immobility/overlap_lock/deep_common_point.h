/// Are two parts locked into each other for good?
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/pose.h"

namespace dismantle::immobility {

struct DeepPoint {
  Eigen::Vector3d point;  ///< frame in which the placements are given
  double depth = 0;       ///< below the surface of the first solid
};

/// A point that lies in both solids, and more than `limit` (> 0) below the surface of `a`; none when there is no such
/// point, or none was found within the budget. Branch and bound over cubes: depths change no faster than the point
/// moves.
///
/// Such a point locks the two. Fix it to `a`: when they are apart it is outside `b`, so on the way it passed through
/// the surface of `b`; there and then that surface was so deep in `a`.
std::optional<DeepPoint> deep_common_point(const Solid& a, const Pose& pose_a, const Solid& b, const Pose& pose_b,
                                           double limit, std::uint64_t most_cubes = 1000);

}  // namespace dismantle::immobility
