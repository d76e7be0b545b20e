/// Who was in the way, for PathResult::blocked_by.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "dismantle/path_planner.h"

namespace dismantle::path {

/// Parts that were touched, most often first, equals by number; those that move themselves are left out.
std::vector<PartId> most_touched(const std::map<PartId, std::uint64_t>& touched, const std::vector<PlacedPart>& moving);

/// The other sides of contacts that touch, ascending, each once; those that move themselves are left out.
std::vector<PartId> touched_parts(const std::vector<Contact>& contacts, const std::vector<PlacedPart>& moving);

}  // namespace dismantle::path
