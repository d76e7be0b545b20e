/// Meshes that are the same surface in two places.
#pragma once

#include <optional>

#include "dismantle/export.h"
#include "dismantle/mesh.h"
#include "dismantle/pose.h"

namespace dismantle::geometry {

/// The displacement that takes each vertex of `a` to within `tolerance` (units of the meshes, per coordinate) of the
/// vertex of `b` with the same number. Nothing when there is none, when the triangles are numbered otherwise, or when
/// there are fewer than three vertices. Mirror images are not congruent.
DISMANTLE_API std::optional<Pose> congruence(const Mesh& a, const Mesh& b, double tolerance);

}  // namespace dismantle::geometry
