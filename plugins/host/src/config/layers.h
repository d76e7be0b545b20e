/// From files and command line to one tree: `extends`, overrides, deep merge.
#pragma once

#include <string>
#include <vector>

#include "dismantle/host/config.h"
#include "dismantle/host/config_node.h"

namespace dismantle {

/// The merged tree, without the keys `schema` and `extends`. Problems are appended.
ConfigNode merged_tree(const ConfigSource& source, std::vector<Diagnostic>& problems);

/// Lays `over` on `base`: maps are merged key by key, everything else is replaced. A section whose `type` changes
/// starts afresh, since the parameters below belong to another plugin.
void merge_config(ConfigNode& base, ConfigNode over);

}  // namespace dismantle
