/// The axis that an overlap surrounds.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace dismantle::verify {

/// A place of the overlap, found on either part. `normal` always points out of the first part.
struct FittedPlace {
  Eigen::Vector3d point, normal;
  double weight = 0;  ///< area
};

struct RoundAxis {
  Eigen::Vector3d point, direction;
};

/// A line such that each of eight equal sectors about it has a place, with all normals pointing away from the line or
/// all towards it, within 60 degrees. nullopt when there is no such line.
std::optional<RoundAxis> round_axis(const std::vector<FittedPlace>& places);

}  // namespace dismantle::verify
