/// The objective of a configuration.
#pragma once

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/host/config.h"
#include "dismantle/host/registry.h"
#include "dismantle/step_check.h"

namespace dismantle {

/// What is up in this assembly: `layout.up`; with "auto" that of its files. @throws Error if it is no direction.
DISMANTLE_API Eigen::Vector3d up_of(const LayoutOptions& layout, const Assembly& assembly);

/// Creates the checks, for an assembly that lies with `up` up. With a target (`constraints.target`) it counts steps,
/// too, unless the configuration says how. `registry` must outlive the result. @throws PluginError.
DISMANTLE_API Objective objective_of(const RunConfig& config, const Registry& registry, const Eigen::Vector3d& up);

}  // namespace dismantle
