/// Containment in convex hulls, by their support in all directions.
#pragma once

#include <vector>

#include "certificates/body.h"

namespace dismantle::certificates {

/// True if the ball is proved to be within the convex hull of the points. Divides the sphere of directions: the support
/// of the points changes no faster than the direction times the distance of the furthest point.
bool ball_in_hull(const Vec3& center, double radius, const std::vector<Vec3>& points);

}  // namespace dismantle::certificates
