/// Test whether a bend of a bar can pass through a hole.
#pragma once

#include <cstdint>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility/section.h"
#include "dismantle/run_context.h"
#include "hook/hook_cage.h"

namespace dismantle::immobility {

/// True if proved that the corner of `bend` can never be on the flat disc within `loop`, a curve on the surface of
/// `around`. Covers all positions on the disc and all directions of the two legs with cells. False if not proved with
/// `max_distances` distance queries, or told to stop. Assembled frame.
bool cannot_pass(const Loop& loop, const Solid& around, const Bend& bend, std::uint64_t max_distances,
                 const RunContext& context);

}  // namespace dismantle::immobility
