/// What makes two rows comparable, and what has changed where they are not.
#pragma once

#include <string>

#include "dismantle/bench/trial_row.h"

namespace dismantle::bench {

/// What all planners of a suite share and `a` and `b` do not, as text, such as "limits.wall"; empty: nothing.
std::string shared_difference(const TrialPlan& a, const TrialPlan& b);

/// The values that differ between two resolved configurations, with the files of plugins: "path_planner.type: bfs ->
/// t_rrt; ...". Empty: none.
std::string changed_values(const std::string& before, const std::string& now);

}  // namespace dismantle::bench
