/// The `components:` section: what is kept together, by names of products.
#pragma once

#include <string>
#include <vector>

#include "dismantle/host/config.h"
#include "dismantle/host/config_node.h"

namespace dismantle {

/// Reads the section and appends errors to `problems`. `places` receives every pattern with its place.
ComponentChoice read_components(const ConfigNode& section, std::vector<ConstraintName>& places,
                                std::vector<Diagnostic>& problems);

/// The section as lines of YAML; none when nothing is set.
std::vector<std::string> component_lines(const ComponentChoice& choice);

}  // namespace dismantle
