/// Obstacles of a search, for PathResult::blocked_by.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "dismantle/path_planner.h"

namespace dismantle::path {

/// Fixed parts sorted by descending number of touches; ties by part id.
std::vector<PartId> most_touched(const std::map<PartId, std::uint64_t>& touched, const std::vector<PlacedPart>& moving);

/// Fixed parts of the contacts that are nearer than `distance`, ascending, without repetition.
std::vector<PartId> touched_parts(const std::vector<Contact>& contacts, const std::vector<PlacedPart>& moving,
                                  double distance);

}  // namespace dismantle::path
