/// Simulated paths carry a pose per time step; most of them lie on straight or screw motions.
#pragma once

#include <vector>

#include "dismantle/path_planner.h"

namespace dismantle::path {

/// Centre (assembled frame) and bounding radius of a moving part.
struct Ball {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// Of the moving parts of a world. The radius is 0 where they do not turn.
std::vector<Ball> balls_of(const World& world);

/// The largest turn, in rad, that thin() leaves between two instants: small ones are verified in far less time than
/// large ones.
constexpr double kMostTurn = 0.25;

/// Drops instants that the screw motions between the instants kept reproduce to within `tolerance`
/// (assembly units, for every point of every moving part). First and last stay. Douglas-Peucker on
/// poses: deterministic, O(n log n) usually.
Path thin(const Path& path, const std::vector<Ball>& bodies, double tolerance);

}  // namespace dismantle::path
