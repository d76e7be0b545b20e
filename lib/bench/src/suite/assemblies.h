/// The `assemblies:` list of a suite.
#pragma once

#include <string>
#include <vector>

#include "dismantle/bench/suite.h"
#include "dismantle/host/config_node.h"

namespace dismantle::bench {

/// Appends what the list names to `suite.assemblies`, in order; what is wrong to `problems`.
void read_assemblies(const ConfigNode& list, Suite& suite, std::vector<Diagnostic>& problems);

/// `text` with $NAME and ${NAME} replaced. $DISMANTLE_DATA has a default: ../shared/data, seen from the working
/// directory or from two folders above the suite. Returns false when a variable is not set; `text` then is its name.
bool expand_variables(std::string& text, const std::filesystem::path& suite_file);

}  // namespace dismantle::bench
