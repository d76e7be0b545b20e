/// A plan file together with the assembly that it is for.
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
  Assembly assembly;  ///< with the plan's scale, of the parts that the plan has
};

/// A context without a time limit, and the plugins that are found; warnings about plugins go to `console`.
RunContext context_for_reading(Registry& registry, Console& console);

/// `file`: plan.json. `input`: where the assembly is, if it has moved; empty: as the plan says. Importers get the
/// parameters that they had when the plan was made. @throws InputError naming what does not fit; Stopped.
LoadedPlan load_plan(const std::string& file, const std::string& input, const Registry& registry,
                     RunContext& context);

}  // namespace dismantle::app
