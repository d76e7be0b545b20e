/// Convex hulls and the proof that two of them are apart (section 3: "disassembled").
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "dismantle/export.h"

namespace dismantle {

/// The points of `points` that are corners of their convex hull, in the order given. Flat or degenerate sets are
/// allowed; for them, and for sets with more than 10 000 corners, the result is a superset of the corners.
DISMANTLE_API std::vector<Eigen::Vector3d> hull_corners(std::span<const Eigen::Vector3d> points);

/// Plane that has all of A on one side and all of B on the other.
struct Separation {
  Eigen::Vector3d normal;  ///< unit, from A towards B
  double gap;              ///< min over B of normal.b minus max over A of normal.a; > 0
};

/// A separating plane of two point sets, or nothing when their hulls touch, overlap or are closer than `min_gap`. The
/// returned plane was checked against every point, so it is a proof. Both sets non-empty.
DISMANTLE_API std::optional<Separation> separate(std::span<const Eigen::Vector3d> a,
                                                 std::span<const Eigen::Vector3d> b, double min_gap = 0.0);

}  // namespace dismantle
