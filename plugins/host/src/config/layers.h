/// Merges files and command line into one tree: `extends`, overrides, deep merge.
#pragma once

#include <string>
#include <vector>

#include "dismantle/host/config.h"
#include "dismantle/host/config_node.h"

namespace dismantle {

/// The merged tree, without the keys `schema` and `extends`. Problems are appended.
ConfigNode merged_tree(const ConfigSource& source, std::vector<Diagnostic>& problems);

/// Merges `over` into `base`: maps are merged key by key, everything else is replaced. A map whose `type` changes
/// replaces the map in `base`, because its parameters belong to another plugin. A map over a list merges single items,
/// named by index or by type (list_items.h). Problems are appended.
void merge_config(ConfigNode& base, ConfigNode over, std::vector<Diagnostic>& problems);

/// The `type` of a map, or the text of a scalar (short for `{type: TEXT}`); otherwise empty.
std::string named_type(const ConfigNode& choice);

}  // namespace dismantle
