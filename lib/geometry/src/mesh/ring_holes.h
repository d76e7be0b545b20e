/// Holes with an island: two rims in one plane, one within the other, are the rims of one ring.
#pragma once

#include <cstdint>
#include <vector>

#include "dismantle/mesh.h"

namespace dismantle::mesh_detail {

/// Vertices along the rim of a hole, in the orientation of a filling.
using Rim = std::vector<std::uint32_t>;

/// Joins the rims of rings. Two discs instead of a ring would be a wall without thickness: both sides of a tube's end.
/// Rims are joined when they belong to one connected surface, lie in one plane, and run in opposite senses. A joined
/// rim visits two vertices twice: it crosses from one rim to the other and back where they are nearest.
std::vector<Rim> join_ring_holes(const Mesh& mesh, std::vector<Rim> rims);

}  // namespace dismantle::mesh_detail
