/// A path planner's answer by push search.
#pragma once

#include "dismantle/path_planner.h"
#include "dismantle/push/tactics.h"

namespace dismantle::push {

/// What the simulator has to be capable of.
Capabilities required();

/// Searches in the motion space that the tactics name, or, with `motion: auto`, by translation and by rotation:
/// in turns of growing rank until both are exhausted; under a depth limit with a number of states for each.
PathResult plan(const PathQuery& query, const Tactics& tactics, RunContext& context);

}  // namespace dismantle::push
