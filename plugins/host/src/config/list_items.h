/// Finds the list item of a lower layer that a key names: `of: {1: {...}}` or `of: {tunnel_forest: {...}}`.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace dismantle {

/// Index of the item that `key` names by index (from 0) or by type, if exactly one item has that type. `types`: types
/// of the items, empty for items without one. Nothing: no such item; see no_item_message().
std::optional<std::size_t> item_index(const std::string& key, const std::vector<std::string>& types);

/// "path_planner.of has no item 'tree'; items are 0 (bfs), 1 (rrt)".
std::string no_item_message(const std::string& list, const std::string& key, const std::vector<std::string>& types);

}  // namespace dismantle
