/// Screws that cut their threads.
#pragma once

#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// "'screw' cuts its thread, 0.45 mm deep, into 'block' (0.3 mm when assembled)": of each pair of a step with a screw
/// whose overlap is deeper along the way than as assembled, by more than a hundredth.
DISMANTLE_API std::vector<std::string> thread_words(const Plan& plan, const PlanStep& step);

}  // namespace dismantle
