/// Subdivision to a longest edge (appendix B.1, step 9).
#pragma once

#include <cstddef>

#include "dismantle/export.h"
#include "dismantle/mesh.h"

namespace dismantle {

/// The same surface without edges longer than `max_edge` (> 0). Halves the longest edge first, in all triangles that
/// share it: a closed mesh stays closed, and no angle falls below half the smallest initial angle. Original vertices
/// keep their indices.
/// @throws InputError if more than `max_triangles` would be needed.
DISMANTLE_API Mesh subdivide(const Mesh& mesh, double max_edge, std::size_t max_triangles = 50'000'000);

}  // namespace dismantle
