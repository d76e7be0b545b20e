/// From files and command line to one tree: `extends`, overrides, deep merge.
#pragma once

#include <string>
#include <vector>

#include "dismantle/host/config.h"
#include "dismantle/host/config_node.h"

namespace dismantle {

/// The merged tree, without the keys `schema` and `extends`. Problems are appended.
ConfigNode merged_tree(const ConfigSource& source, std::vector<Diagnostic>& problems);

/// Lays `over` on `base`: maps are merged key by key, everything else is replaced. A map with a `type` that changes
/// starts afresh, since the parameters below belong to another plugin. Over a list, a map names items by index or by
/// type (list_items.h): these are merged one by one. Problems are appended.
void merge_config(ConfigNode& base, ConfigNode over, std::vector<Diagnostic>& problems);

/// The `type` of a map, or the text of a scalar, which stands for `{type: TEXT}`; empty where there is none.
std::string named_type(const ConfigNode& choice);

}  // namespace dismantle
