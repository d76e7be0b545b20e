/// Groups so thin that an overlap allowed everywhere would let them pass through walls.
#pragma once

#include <cstddef>
#include <vector>

#include "dismantle/path_planner.h"

namespace dismantle::portfolio {

/// Radii of balls inside the mesh that touch its surface, at up to `max_count` places that are far from each other.
std::vector<double> inner_radii(const Mesh& mesh, std::size_t max_count);

/// Is the initial overlap of a moving with a fixed part a large share of the group's thickness, as of a wire that is
/// half sunk into its holder? Contact search rarely finds paths of such groups.
bool thinner_than_overlap(const PathQuery& query);

}  // namespace dismantle::portfolio
