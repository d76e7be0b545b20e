/// The axis that an overlap goes all around.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace dismantle::verify {

/// A place of the overlap. `normal` points out of the inner part, at whichever of the two the place was found.
struct FittedPlace {
  Eigen::Vector3d point, normal;
  double weight = 0;  ///< area
};

struct RoundAxis {
  Eigen::Vector3d point, direction;
};

/// A line about which each of eight equal sectors has a place, whose normals point all away from it or all towards it,
/// within 60 degrees. None when there is no such line.
std::optional<RoundAxis> round_axis(const std::vector<FittedPlace>& places);

}  // namespace dismantle::verify
