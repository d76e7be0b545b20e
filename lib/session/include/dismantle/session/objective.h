/// The objective of a configuration.
#pragma once

#include "dismantle/export.h"
#include "dismantle/host/config.h"
#include "dismantle/host/registry.h"
#include "dismantle/step_check.h"

namespace dismantle {

/// Creates the checks. With a target (`constraints.target`) it counts steps, too, unless the configuration says how.
/// `registry` must outlive the result. @throws PluginError.
DISMANTLE_API Objective objective_of(const RunConfig& config, const Registry& registry);

}  // namespace dismantle
