/// The `assemblies:` list of a suite.
#pragma once

#include <string>
#include <vector>

#include "dismantle/bench/suite.h"
#include "dismantle/host/config_node.h"

namespace dismantle::bench {

/// Appends the assemblies in the list to `suite.assemblies`, in order, and errors to `problems`.
void read_assemblies(const ConfigNode& list, Suite& suite, std::vector<Diagnostic>& problems);

/// Replaces $NAME and ${NAME} in `text`. $DISMANTLE_DATA defaults to ../shared/data, relative to the working directory
/// or to two folders above the suite. If a variable is not set, returns false with its name in `text`.
bool expand_variables(std::string& text, const std::filesystem::path& suite_file);

}  // namespace dismantle::bench
