/// Turns a configuration into the arguments of run().
#pragma once

#include "dismantle/engine/run.h"
#include "dismantle/host/config.h"
#include "dismantle/host/registry.h"

namespace dismantle {

/// Creates the plugins that `config` chooses, for an assembly that lies with `up` up. `registry` must outlive the
/// result. @throws PluginError.
PlanningSetup planning_setup_of(const RunConfig& config, const Registry& registry, const Eigen::Vector3d& up);

/// Everything that a configuration says about a run. Without the constraints, which are about one assembly.
RunOptions run_options_of(const RunConfig& config);

}  // namespace dismantle
