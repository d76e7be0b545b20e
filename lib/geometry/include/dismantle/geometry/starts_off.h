/// Proof that a solid is not inside a shrunken copy of another.
#pragma once

#include "dismantle/geometry/relative_motion.h"
#include "dismantle/geometry/solid.h"

namespace dismantle::geometry {

/// True if each shell of `b` (placed by `to_a`) has a point outside every copy of `a` that is shrunken by `reach` or
/// less. False: no such point among the vertices tried.
bool starts_off(const Solid& b, const Solid& a, const Placement& to_a, double reach);

}  // namespace dismantle::geometry
