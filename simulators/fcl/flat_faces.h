/// Fewer triangles for the same surface.
#pragma once

#include "dismantle/mesh.h"

namespace dismantle::mesh_collision {

/// Removes vertices that lie inside flat faces or on straight edges between two of them, by collapsing edges. Finely
/// meshed flat faces make collision checks slow: where two lie close, every triangle is tested.
///
/// A face is a set of connected triangles whose vertices lie within `tolerance` (the mesh's units) of one plane; the
/// remaining vertices do not move, so no point of the surface moves by more than about `tolerance`. The mesh stays
/// closed and keeps its shells. Deterministic.
Mesh merge_flat_faces(const Mesh& mesh, double tolerance);

}  // namespace dismantle::mesh_collision
