/// Rigid congruence of two meshes.
#pragma once

#include <optional>

#include "dismantle/export.h"
#include "dismantle/mesh.h"
#include "dismantle/pose.h"

namespace dismantle::geometry {

/// Rigid motion that takes each vertex of `a` to within `tolerance` (units of the meshes, per coordinate) of the vertex
/// of `b` with the same index. Empty if there is no such motion, if the triangles have other indices, or for fewer than
/// three vertices. Mirror images are not congruent.
DISMANTLE_API std::optional<Pose> congruence(const Mesh& a, const Mesh& b, double tolerance);

}  // namespace dismantle::geometry
