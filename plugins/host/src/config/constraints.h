/// The `constraints:` section: lists of part names.
#pragma once

#include <string>
#include <vector>

#include "dismantle/host/config.h"
#include "dismantle/host/config_node.h"

namespace dismantle {

/// Reads the section and appends errors to `problems`. The names are checked against the parts later.
/// `places` receives every name with its place. Constraints that contradict each other are errors (a cycle of `before`,
/// a base part that must leave, a constrained part that is ignored).
NamedConstraints read_constraints(const ConfigNode& section, std::vector<ConstraintName>& places,
                                  std::vector<Diagnostic>& problems);

/// The keys of the section.
const std::vector<std::string>& constraint_keys();

}  // namespace dismantle
