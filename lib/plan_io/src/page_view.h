/// What the page shows of a plan and is computed here, so that page, plan.glb and `explain` cannot disagree.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/step_runs.h"

namespace dismantle {

/// The plan as the page has it: without most of the poses on straight stretches, and without proofs of holds.
struct DrawnPlan {
  explicit DrawnPlan(const Plan& whole);
  Plan plan;
  /// Numbers, among those of the whole plan, of the poses of all steps that move something: one step after the other.
  std::vector<std::uint32_t> disassembly, assembly;
};

/// `view` of a page (docs/viewer.md): times, runs of steps, presence, exploded view, reasons and advice.
/// @throws InputError when the plan names a part that the assembly does not have.
nlohmann::ordered_json page_view(const Plan& plan, const DrawnPlan& drawn, const Assembly& assembly,
                                 const PartShapes& shapes, const ExplainSettings& settings);

}  // namespace dismantle
