/// Pushes first; where they get nowhere for long, a forest of trees takes turns with them.
#pragma once

#include "dismantle/path_planner.h"
#include "dismantle/push/tactics.h"
#include "parameters.h"

namespace dismantle::guided {

/// The search over pushes alone for `forest_after` steps; then the forest and it go on in turns of the same length,
/// each twice as long as the last. Ends when one of them has found a way, the effort is used up, or neither has
/// anything left to try (`exhausted`). Counts of the forest begin with "forest_".
PathResult plan_with_forest(const PathQuery& query, const Parameters& parameters, const push::Tactics& tactics,
                            RunContext& context);

}  // namespace dismantle::guided
