/// Convex polygons in a plane of space.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace dismantle::statics {

using Polygon = std::vector<Eigen::Vector3d>;

/// The part of a convex polygon where normal . p <= limit. `kept` is another polygon, whose memory is used again.
void clip(const Polygon& polygon, const Eigen::Vector3d& normal, double limit, Polygon& kept);
/// Area vector of a polygon: its length is the area.
Eigen::Vector3d area_of(const Polygon& polygon);
/// Corners of the convex hull of points near a plane with this normal; at most `most`, those that hold most of the
/// area. A set without area gives its ends.
Polygon hull_in_plane(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& normal, std::size_t most);

}  // namespace dismantle::statics
