/// A plan file together with its assembly.
#pragma once

#include <string>

#include "dismantle/assembly.h"
#include "dismantle/console.h"
#include "dismantle/host/registry.h"
#include "dismantle/plan.h"
#include "dismantle/run_context.h"

namespace dismantle::app {

struct LoadedPlan {
  Plan plan;
  Assembly assembly;  ///< the parts in the plan, with the plan's scale
};

/// A context without a time limit. Also scans for plugins into `registry`; warnings about them go to `console`.
RunContext context_for_reading(Registry& registry, Console& console);

/// `file`: plan.json. `input`: the assembly if it has moved; empty: as stated in the plan. Importers get the parameters
/// with which the plan was made. @throws InputError naming what does not match the plan; Stopped.
LoadedPlan load_plan(const std::string& file, const std::string& input, const Registry& registry, RunContext& context);

}  // namespace dismantle::app
