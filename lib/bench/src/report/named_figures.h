/// Columns that hold figures under names of plugins, as JSON.
#pragma once

#include <map>
#include <string>

namespace dismantle::bench {

/// The numbers of the object `json`, with `prefix` before each name. What is no number is left out.
std::map<std::string, double> named_figures(const std::string& json, const std::string& prefix);

}  // namespace dismantle::bench
