/// Slits: T-junctions whose vertex lies a little off the edge, beside the surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dismantle/mesh.h"

namespace dismantle::mesh_detail {

/// Closes narrow holes along an edge whose filling would be folded back over its neighbours: it would be a fin without
/// thickness, a wall that nothing may touch. The triangle at that edge is split, so that its pieces have the vertices
/// of the rim; it moves by no more than the width of the hole. `rims`: vertices along the rims of holes, in the
/// orientation of a filling. Returns for each rim whether it was closed.
std::vector<char> close_slits(Mesh& mesh, const std::vector<std::vector<std::uint32_t>>& rims);

}  // namespace dismantle::mesh_detail
