/// The importers that read an input.
#pragma once

#include <memory>
#include <vector>

#include "dismantle/host/registry.h"
#include "dismantle/importer.h"

namespace dismantle {

/// All available importers, by id. `params`: parameters that differ from the defaults.
/// @throws PluginError when `params` names an unknown importer or a bad parameter.
std::vector<std::shared_ptr<Importer>> importers_of(const Registry& registry, const ImportParameters& params);

}  // namespace dismantle
