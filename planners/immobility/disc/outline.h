/// Convex outlines in a plane.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "dismantle/aabb.h"

namespace dismantle::immobility {

using Outline = std::vector<Eigen::Vector2d>;  ///< convex, counter-clockwise

inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Distance of a point from the region inside the outline; 0 inside.
double distance(const Outline& outline, const Eigen::Vector2d& p);

/// Convex hull (Andrew's monotone chain); less than three corners when the points are on a line.
Outline hull_of(std::vector<Eigen::Vector2d> points);

/// The parts of a convex piece left and right of the line through `a` along a direction.
std::pair<Outline, Outline> cut(const Outline& piece, const Eigen::Vector2d& a, const Eigen::Vector2d& along);

double area(const Outline& piece);

/// Box of points in the plane; z is 0.
Aabb flat_box(const std::vector<Eigen::Vector2d>& points);

}  // namespace dismantle::immobility
