/// What the page shows of a plan and is computed here, so that page, plan.glb and `explain` cannot disagree.
#pragma once

#include <nlohmann/json.hpp>

#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/step_runs.h"

namespace dismantle {

/// `view` of a page (docs/viewer.md): times, runs of steps, presence, exploded view, reasons and advice.
/// `drawn`: the same plan with the poses that the page has. Times are those of its poses.
/// @throws InputError when the plan names a part that the assembly does not have.
nlohmann::ordered_json page_view(const Plan& plan, const Plan& drawn, const Assembly& assembly,
                                 const PartShapes& shapes, const ExplainSettings& settings);

}  // namespace dismantle
