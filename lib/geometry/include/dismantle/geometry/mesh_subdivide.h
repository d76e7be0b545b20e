/// Subdivision to a longest edge (appendix B.1, step 9).
#pragma once

#include <cstddef>

#include "dismantle/export.h"
#include "dismantle/mesh.h"

namespace dismantle {

/// The same surface with no edge longer than `max_edge` (> 0), by halving the longest edge first, in all triangles that
/// share it: a closed mesh stays closed, and no angle gets smaller than half the smallest one there was.
/// Original vertices keep their numbers.
/// @throws InputError when more than `max_triangles` would be needed.
DISMANTLE_API Mesh subdivide(const Mesh& mesh, double max_edge, std::size_t max_triangles = 50'000'000);

}  // namespace dismantle
