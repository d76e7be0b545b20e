/// Components of the assembly as constraints of a run.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dismantle/disassembly.h"
#include "dismantle/host/config.h"
#include "dismantle/plan.h"
#include "dismantle/preparation/components.h"

namespace dismantle {

/// Those of `assembly`, read as `config` says. They are all open when the sequence planner does not keep parts together
/// (`keeps`: whether it does), and one is open when the user orders its bodies or when `earlier` (null: none) takes it
/// apart. @throws ConfigError for names of products that are not there; Error when the user asks for components and
/// the planner does not keep them.
std::vector<Component> kept_components(const Assembly& assembly, const RunConfig& config, bool keeps,
                                       const Disassembly* earlier);

/// Adds those that are kept to `constraints.together`.
void keep_together(const std::vector<Component>& components, Constraints& constraints);

/// As the plan states them: for a unit that did not come out as a whole, with the verified reason and what to do.
std::vector<PlanComponent> plan_components(const std::vector<Component>& components, const Plan& plan);

}  // namespace dismantle
