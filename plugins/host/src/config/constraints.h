/// The `constraints:` section: names of parts, in lists.
#pragma once

#include <string>
#include <vector>

#include "dismantle/host/config.h"
#include "dismantle/host/config_node.h"

namespace dismantle {

/// Reads the section; what is wrong with it goes to `problems`. The names are checked against the parts later.
/// `places` receives every name with its place. Constraints that contradict each other (a circle of `before`, a base that
/// is to leave, a part that is ignored) are problems.
NamedConstraints read_constraints(const ConfigNode& section, std::vector<ConstraintName>& places,
                                  std::vector<Diagnostic>& problems);

/// The keys of the section.
const std::vector<std::string>& constraint_keys();

}  // namespace dismantle
