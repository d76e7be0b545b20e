/// `seeds:` of a suite or of one of its planners.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dismantle/host/config.h"

namespace dismantle::bench {

/// Reads a seed, a range such as 1..6, or a list of them. Problems are added to `problems`, each with the prefix
/// `place`.
std::vector<std::int64_t> read_seeds(const ConfigNode& seeds, const std::string& place,
                                     std::vector<Diagnostic>& problems);

}  // namespace dismantle::bench
