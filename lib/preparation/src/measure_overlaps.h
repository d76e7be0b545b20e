/// How deep assembled parts are in each other.
#pragma once

#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// Depth and place of all pairs that overlap by more than rounding, sorted by their ids. Pairs that are alike, as
/// bricks are, overlap alike: the first of them is measured. Throws when the context says to stop.
std::vector<InitialOverlap> measure_overlaps(const std::vector<Part>& parts, const RunContext& context);

}  // namespace dismantle
