/// Deadlines of searches and of portions of searches.
#pragma once

#include "dismantle/path_planner.h"

namespace dismantle::path {

/// Counted from now; never passes if the budget has no time limit.
inline Deadline deadline_of(const Budget& budget) {
  return budget.timeout > 0 ? Deadline::after_seconds(budget.timeout) : Deadline();
}

/// For a search that begins now: its own deadline or that of the run, whichever is earlier.
inline Deadline deadline_of(const PathQuery& query, const RunContext& context) {
  return context.deadline.earlier(deadline_of(query.budget));
}

}  // namespace dismantle::path
