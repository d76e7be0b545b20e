/// Is a solid certainly not within a shrunken copy of another?
#pragma once

#include "dismantle/geometry/relative_motion.h"
#include "dismantle/geometry/solid.h"

namespace dismantle::geometry {

/// Each shell of `b` (placed by `to_a`) has a point that is outside every copy of `a` shrunken by `reach` or less: it
/// is outside `a`, and further from its surface than any displacement goes. False: not found among some tries.
bool starts_off(const Solid& b, const Solid& a, const Placement& to_a, double reach);

}  // namespace dismantle::geometry
