/// Pushes first; where they get nowhere, a walk that is led out through free space, one that uses what the judge
/// tolerates, and a forest of trees.
#pragma once

#include "dismantle/path_planner.h"
#include "dismantle/push/tactics.h"
#include "dismantle/tolerant_walk/geometry_cache.h"
#include "parameters.h"

namespace dismantle::guided {

/// The search over pushes alone for `forest_after` steps. If they are in vain, one led walk (if free space leads out)
/// and one as in `squeeze`. Then the forest and the pushes go on in turns of the same length, each twice as long as the
/// last. Ends when one of them has found a way, the effort is used up, or none has anything left to try (`exhausted`).
///
/// Under a depth limit, from some depth on: the walk that is led, the pushes and the other walk, in proportion to it;
/// no forest. An idle thread of the context's executor may begin with the pushes during the first.
/// Counts of the walks and of the forest begin with "led_", "squeeze_" and "forest_".
PathResult plan_with_others(const PathQuery& query, const Parameters& parameters, const push::Tactics& tactics,
                            tolerant_walk::GeometryCache& cache, RunContext& context);

}  // namespace dismantle::guided
