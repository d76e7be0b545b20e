/// Why the steps of a plan are in this order, in words.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// What has to come before and after the step Plan::disassembly[index], with the numbers of the mode: "after step 2,
/// before steps 4 and 7-9: parts are in the way otherwise". Empty if the plan does not say it.
DISMANTLE_API std::string order_words(const Plan& plan, std::size_t index, bool disassembly);

/// Which checks of the objective cost what and in which steps, and whether another order is known to cost more.
/// Sentences without a full stop.
DISMANTLE_API std::vector<std::string> cost_words(const Plan& plan, bool disassembly);

/// "it costs 7.1 (before: 5.6): directions 3 (2), gravity 1 (0)"; empty if neither was judged.
DISMANTLE_API std::string cost_change_words(const PlanObjective& before, const PlanObjective& now);

}  // namespace dismantle
