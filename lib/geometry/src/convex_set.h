/// A set of points for the search of a separating plane, given by its support function.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "dismantle/geometry/hull.h"

namespace dismantle::geometry {

struct ConvexSet {
  Eigen::Vector3d any;  ///< one of the points
  double extent = 0;    ///< bound of absolute coordinates
  std::function<Eigen::Vector3d(const Eigen::Vector3d& direction)> farthest;
};

/// separate() for two convex sets.
std::optional<Separation> separate(const ConvexSet& a, const ConvexSet& b, double min_gap);

}  // namespace dismantle::geometry
