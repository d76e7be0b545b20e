/// From a configuration to what the runner takes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dismantle/engine/run.h"
#include "dismantle/export.h"
#include "dismantle/host/config.h"
#include "dismantle/host/registry.h"
#include "dismantle/importer.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {

/// The plugins that `config` chooses. `registry` must outlive what is returned. @throws PluginError.
DISMANTLE_API PlanningSetup planning_setup_of(const RunConfig& config, const Registry& registry);

/// `part`: plan just this one; empty: all.
DISMANTLE_API RunOptions run_options_of(const RunConfig& config, const std::string& part);

/// All importers that are there, by id. `params`: those that are not the default.
/// @throws PluginError when `params` names an importer that is not there, or a bad parameter.
DISMANTLE_API std::vector<std::shared_ptr<Importer>> importers_of(const Registry& registry,
                                                                  const ImportParams& params = {});

/// The immobility prover of a kind of certificates, with its defaults. `registry` must outlive what is returned.
DISMANTLE_API ProverOfKind prover_of_kind(const Registry& registry);

/// What of `config.importers` is not the default.
DISMANTLE_API ImportParams import_params_of(const RunConfig& config, const Registry& registry);

}  // namespace dismantle
