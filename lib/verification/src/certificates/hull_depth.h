/// Convex hulls, by their support in all directions.
#pragma once

#include <vector>

#include "certificates/body.h"

namespace dismantle::certificates {

/// Is the ball within the convex hull of the points? Proved by dividing the sphere of directions: the support of the
/// points along a direction changes no faster than the direction, times the distance of the furthest point.
bool ball_in_hull(const Vec3& center, double radius, const std::vector<Vec3>& points);

}  // namespace dismantle::certificates
