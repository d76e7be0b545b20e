/// Thinning of simulated paths: they have a pose per time step, and most of these lie on straight or screw motions.
#pragma once

#include <vector>

#include "dismantle/path_planner.h"

namespace dismantle::path {

/// Centre (assembled frame) and bounding radius of a moving part.
struct Ball {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// Balls of the moving parts of a world. The radius is 0 if the motion space has no rotation.
std::vector<Ball> balls_of(const World& world);

/// Largest rotation (rad) between two instants for which thin() drops those in between: small rotations are verified in
/// far less time.
constexpr double kMostTurn = 0.25;

/// Drops instants that the screw motions between the instants kept reproduce to within `tolerance`
/// (assembly units, for every point of every moving part). First and last stay. Douglas-Peucker on
/// poses: deterministic, O(n log n) usually.
Path thin(const Path& path, const std::vector<Ball>& bodies, double tolerance);

}  // namespace dismantle::path
