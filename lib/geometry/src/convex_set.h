/// A set of points as the search for a separating plane sees it: which of them is farthest in a direction.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "dismantle/geometry/hull.h"

namespace dismantle::geometry {

struct ConvexSet {
  Eigen::Vector3d any;  ///< one of the points
  double extent = 0;    ///< no coordinate of a point is larger
  std::function<Eigen::Vector3d(const Eigen::Vector3d& direction)> farthest;
};

/// As separate() of two lists of points.
std::optional<Separation> separate(const ConvexSet& a, const ConvexSet& b, double min_gap);

}  // namespace dismantle::geometry
