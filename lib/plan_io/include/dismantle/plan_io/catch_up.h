/// A copy of a plan that grows, kept up to date at the cost of what is new.
#pragma once

#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// Makes `known` equal to `now`. It must be the same plan some steps ago: while a run goes on, steps are added, and only
/// the last one may change. All other steps, and what a plan says before the first step (generator, assembly, seed,
/// tolerance), are taken to be the same and not copied.
DISMANTLE_API void catch_up(Plan& known, const Plan& now);

}  // namespace dismantle
