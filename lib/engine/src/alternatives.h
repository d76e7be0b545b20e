/// What other orders of a plan would cost.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/constraints.h"
#include "dismantle/disassembly.h"
#include "dismantle/plan.h"
#include "dismantle/run_context.h"
#include "dismantle/step_check.h"

namespace dismantle {

/// Adds to the objective of a plan that judge() has judged what the steps that cost most would cost at another place:
/// of the places near by that `needed` (needed_steps()) and the constraints allow, the cheapest. All other steps stay
/// in their order, and each keeps its path. What is looked at is counted. Nothing if the run is to stop.
void add_other_places(Plan& plan, const Disassembly& done, const std::vector<std::vector<std::size_t>>& needed,
                      const Assembly& assembly, const Objective& objective, const Constraints& constraints,
                      const RunContext& context);

/// Adds what the order costs that the sequence planner found first and put a better one in the place of:
/// `first_order.K` of its counts, by the K-th check. These counts are taken out.
void add_first_order(Plan& plan, std::map<std::string, double>& counts);

}  // namespace dismantle
