/// Keeps a copy of a growing plan up to date, at a cost that depends only on the new steps.
#pragma once

#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// Makes `known` equal to `now`. It must be an earlier state of the same plan: a run adds steps and changes only the
/// last one. All other steps, and the data before the first step (generator, assembly, seed, tolerance), are assumed
/// equal and not copied.
DISMANTLE_API void catch_up(Plan& known, const Plan& now);

}  // namespace dismantle
