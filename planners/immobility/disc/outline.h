/// Convex outlines in a plane.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "dismantle/aabb.h"

namespace dismantle::immobility {

using Outline = std::vector<Eigen::Vector2d>;  ///< convex, counter-clockwise

inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Distance of a point from what is inside the outline, 0 there.
double distance(const Outline& outline, const Eigen::Vector2d& p);

/// Around some points; less than three corners when they are on a line.
Outline hull_of(std::vector<Eigen::Vector2d> points);

/// What of it is left of the line through a point along a direction, and what is right of it.
std::pair<Outline, Outline> cut(const Outline& piece, const Eigen::Vector2d& a, const Eigen::Vector2d& along);

double area(const Outline& piece);

/// z is 0.
Aabb flat_box(const std::vector<Eigen::Vector2d>& points);

}  // namespace dismantle::immobility
