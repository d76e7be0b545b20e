/// What a plan is worth: what was checked, what was not, and what was taken for granted.
#pragma once

#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// Sentences without a full stop, for people.
struct PlanAccount {
  std::vector<std::string> checked, not_checked, assumed;
};

/// From what the plan says: its steps, the checks of its objective and their notes on the plan as a whole.
DISMANTLE_API PlanAccount account_of(const Plan& plan);

}  // namespace dismantle
