/// Why the steps of a plan are in this order, in words.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// What has to come before and after the step Plan::disassembly[index], with the numbers of the mode: "after step 2,
/// before steps 4 and 7-9: parts are in the way otherwise", and other_place_words(). Empty if the plan says neither.
DISMANTLE_API std::string order_words(const Plan& plan, std::size_t index, bool disassembly);

/// What it would cost to do the step at another place: "before step 3 it would cost 2 more: gravity 2 more (2 parts
/// must be held)". Empty if the plan does not say it.
DISMANTLE_API std::string other_place_words(const Plan& plan, std::size_t index, bool disassembly);

/// What the order costs that was found first; empty if the plan does not say it.
DISMANTLE_API std::string first_order_words(const PlanObjective& objective);

/// All checks, with their weights.
DISMANTLE_API double cost_of(const PlanAlternative& other);

/// Which checks of the objective cost what and in which steps, whether another order is known to cost more, and what
/// the order costs that was found first. Sentences without a full stop.
DISMANTLE_API std::vector<std::string> cost_words(const Plan& plan, bool disassembly);

/// "it costs 7.1 (before: 5.6): directions 3 (2), gravity 1 (0)"; empty if neither was judged.
DISMANTLE_API std::string cost_change_words(const PlanObjective& before, const PlanObjective& now);

}  // namespace dismantle
