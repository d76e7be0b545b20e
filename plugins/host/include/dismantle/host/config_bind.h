/// Converts nodes to typed values, with a diagnostic for every value that does not fit.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/host/config_node.h"
#include "dismantle/export.h"
#include "dismantle/parameters.h"

namespace dismantle {

/// The section that is being bound, for messages.
struct SectionContext {
  std::string name;    ///< "path_planner"
  std::string type;    ///< id, empty for sections without one
  std::string source;  ///< "bfs 0.1.0, libbfs.so", empty for sections without a plugin
};

/// Parameter name -> sections that have a parameter of this name.
using KeyHomes = std::map<std::string, std::vector<std::string>>;

/// The value of `node` for `spec`, which must not be a plugin parameter; otherwise nothing, and a diagnostic.
DISMANTLE_API std::optional<ParamValue> bind_value(const ParamSpec& spec, const ConfigNode& node,
                                                   const SectionContext& context, std::vector<Diagnostic>& problems);

/// The complete values of a section without plugins (`node` may be nullptr: all defaults). Adds "<name>.<key>" to
/// `origins`.
DISMANTLE_API ParamSet bind_section(const std::vector<ParamSpec>& specs, const ConfigNode* node,
                                    const SectionContext& context, const KeyHomes& homes,
                                    std::map<std::string, std::string>& origins, std::vector<Diagnostic>& problems);

/// "unknown key 'goal_bais' in path_planner (t_rrt); did you mean 'goal_bias'?" `advanced`: keys of its map `advanced`.
DISMANTLE_API std::string unknown_key_message(const std::string& key, const SectionContext& context,
                                              const std::vector<std::string>& known, const KeyHomes& homes,
                                              const std::vector<std::string>& advanced = {});

/// Checks the key `schema` of a file and removes it from the tree.
DISMANTLE_API void take_schema(ConfigNode& root, std::vector<Diagnostic>& problems);

/// Sorts by file, in order of first appearance, then by line and column.
DISMANTLE_API void sort_by_place(std::vector<Diagnostic>& problems);

}  // namespace dismantle
