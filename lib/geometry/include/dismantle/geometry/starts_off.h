/// A test that proves a solid not to be within a shrunken copy of another.
#pragma once

#include "dismantle/geometry/relative_motion.h"
#include "dismantle/geometry/solid.h"

namespace dismantle::geometry {

/// Each shell of `b` (placed by `to_a`) has a point that is outside every copy of `a` shrunken by `reach` or less: it
/// is outside `a`, and further from its surface than any displacement. False: no such point among 64 vertices.
bool starts_off(const Solid& b, const Solid& a, const Placement& to_a, double reach);

}  // namespace dismantle::geometry
