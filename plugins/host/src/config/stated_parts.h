/// The `parts:` section: what the user states of parts.
#pragma once

#include <vector>

#include "dismantle/host/config.h"
#include "dismantle/host/config_node.h"

namespace dismantle {

/// Reads the section and appends errors to `problems`.
std::vector<StatedPart> read_stated_parts(const ConfigNode& section, std::vector<Diagnostic>& problems);

}  // namespace dismantle
