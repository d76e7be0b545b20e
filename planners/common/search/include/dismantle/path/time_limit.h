/// When a search, or a portion of one, has to end.
#pragma once

#include "dismantle/path_planner.h"

namespace dismantle::path {

/// From now on; never without a time limit.
inline Deadline deadline_of(const Budget& budget) {
  return budget.timeout > 0 ? Deadline::after_seconds(budget.timeout) : Deadline();
}

/// Of a whole search that begins now: its own time limit, or that of the run.
inline Deadline deadline_of(const PathQuery& query, const RunContext& context) {
  return context.deadline.earlier(deadline_of(query.budget));
}

}  // namespace dismantle::path
