/// What lies outside of a box without a depth limit.
#pragma once

#include "dismantle/aabb.h"
#include "dismantle/geometry/solid.h"

namespace dismantle::geometry {

/// True if no point of the closed solid is in `box` outside of `inner`, which it overlaps; both in the assembled frame
/// of the solid. False: there may be one.
bool is_free_outside(const Solid& solid, const Aabb& box, const Aabb& inner);

}  // namespace dismantle::geometry
