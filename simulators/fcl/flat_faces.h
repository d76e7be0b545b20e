/// Fewer triangles for the same surface.
#pragma once

#include "dismantle/mesh.h"

namespace dismantle::mesh_collision {

/// Removes vertices that lie inside flat faces or on straight edges between two of them, by collapsing edges. Finely
/// cut flat faces cost collision checks dearly: where two of them lie close, every triangle is looked at.
///
/// A face is a set of connected triangles whose vertices lie within `tolerance` (the mesh's units) of one plane; what
/// remains are vertices of the mesh as they were, so no point of the surface moves by more than about that. Stays
/// closed and keeps its shells. Deterministic.
Mesh merge_flat_faces(const Mesh& mesh, double tolerance);

}  // namespace dismantle::mesh_collision
