/// Surfaces that touch themselves.
#pragma once

#include "dismantle/mesh.h"

namespace dismantle::geometry {

/// The same surface with a vertex of its own for each sheet that meets at a corner or edge. Where a solid touches
/// itself along an edge, as two blocks joined diagonally, the triangles on both sides of the same material belong
/// together. So each vertex has one fan of triangles, and a surface that moves inwards leaves the other sheets.
Mesh without_pinches(Mesh mesh);

}  // namespace dismantle::geometry
