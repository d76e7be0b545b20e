/// Where a pair of parts may be as deep in each other as when assembled.
#pragma once

#include <optional>

#include "dismantle/aabb.h"
#include "dismantle/assembly.h"
#include "dismantle/export.h"

namespace dismantle::geometry {

/// The only region in which the overlap of a pair is allowed, if that is deeper than ten times `max_penetration`: all
/// of the measured overlap, grown by its depth and `max_penetration`. Assembly units, assembled frame of both parts.
/// None: the overlap is allowed everywhere, as one that the user declares, or one of an open part (Verifier, law 3).
DISMANTLE_API std::optional<Aabb> overlap_region(const Assembly& assembly, const InitialOverlap& overlap,
                                                 double max_penetration);

}  // namespace dismantle::geometry
