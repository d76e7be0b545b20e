/// What the page shows of each step besides its motion.
#pragma once

#include <nlohmann/json.hpp>

#include "dismantle/plan.h"
#include "dismantle/plan_io/step_runs.h"

namespace dismantle {

/// `view.steps` of a page (docs/viewer.md): how the assembly lies, what must be held.
nlohmann::ordered_json page_steps(const Plan& plan);

/// `view.runs` of a page: the runs of several steps, in both directions.
nlohmann::ordered_json page_runs(const Plan& plan, const std::vector<StepRun>& runs);

}  // namespace dismantle
