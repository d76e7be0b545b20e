/// What lies outside of a box without a depth limit.
#pragma once

#include "dismantle/aabb.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/geometry/sweep.h"

namespace dismantle::geometry {

/// True if no point of the closed solid is in the swept hull outside of `inner`, which is given in the assembled frame
/// of the solid; the hull is in its local frame. False: there may be one.
bool is_free_outside(const Solid& solid, const Sweep& hull, const Aabb& inner);

}  // namespace dismantle::geometry
