/// Turns a configuration into the arguments of run().
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dismantle/engine/judgement.h"
#include "dismantle/engine/run.h"
#include "dismantle/export.h"
#include "dismantle/host/config.h"
#include "dismantle/host/registry.h"
#include "dismantle/importer.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {

/// Creates the plugins that `config` chooses. `registry` must outlive the result. @throws PluginError.
DISMANTLE_API PlanningSetup planning_setup_of(const RunConfig& config, const Registry& registry);

/// `part`: plan only this part; empty: all parts.
DISMANTLE_API RunOptions run_options_of(const RunConfig& config, const std::string& part);

/// All available importers, by id. `params`: parameters that differ from the defaults.
/// @throws PluginError when `params` names an unknown importer or a bad parameter.
DISMANTLE_API std::vector<std::shared_ptr<Importer>> importers_of(const Registry& registry,
                                                                  const ImportParams& params = {});

/// Returns the immobility prover of a certificate kind, with its defaults. `registry` must outlive the result.
DISMANTLE_API ProverOfKind prover_of_kind(const Registry& registry);

/// Creates step checks. Its function throws PluginError when there is no such check. `registry` must outlive the result.
DISMANTLE_API CheckOfType check_of_type(const Registry& registry);

/// The parameters in `config.importers` that differ from the defaults.
DISMANTLE_API ImportParams import_params_of(const RunConfig& config, const Registry& registry);

}  // namespace dismantle
