/// `plugins:` of a suite: folders with plugins for all planners.
#pragma once

#include <filesystem>
#include <vector>

#include "dismantle/host/config.h"

namespace dismantle::bench {

/// Reads `plugins: {search_paths: [...]}`; paths are relative to `folder`. Problems are added to `problems`.
std::vector<std::filesystem::path> read_search_paths(const ConfigNode& plugins, const std::filesystem::path& folder,
                                                     std::vector<Diagnostic>& problems);

}  // namespace dismantle::bench
