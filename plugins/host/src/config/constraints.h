/// The `constraints:` section: names of parts, in lists.
#pragma once

#include <string>
#include <vector>

#include "dismantle/host/config.h"

namespace dismantle {

/// Reads the section; what is wrong with it goes to `problems`. The names are checked against the parts later.
NamedConstraints read_constraints(const ConfigNode& section, std::vector<Diagnostic>& problems);

/// The keys of the section.
const std::vector<std::string>& constraint_keys();

}  // namespace dismantle
