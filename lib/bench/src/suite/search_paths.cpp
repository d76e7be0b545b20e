#include "suite/search_paths.h"

#include <fmt/format.h>

namespace dismantle::bench {

namespace fs = std::filesystem;

std::vector<fs::path> read_search_paths(const ConfigNode& plugins, const fs::path& folder,
                                        std::vector<Diagnostic>& problems) {
  std::vector<fs::path> out;
  const auto* list = plugins.find("search_paths");
  if (list == nullptr || plugins.members.size() != 1 || list->value.kind != ConfigNode::Kind::sequence) {
    problems.push_back(plugins.mark.error("plugins must be a map with the list search_paths, and nothing else"));
    return out;
  }
  for (const ConfigNode& item : list->value.items) {
    const fs::path path = (folder / item.scalar).lexically_normal();
    std::error_code error;
    if (item.scalar.empty() || !fs::exists(path, error))
      problems.push_back(item.mark.error(fmt::format("plugin folder '{}' does not exist", path.string())));
    else
      out.push_back(path);
  }
  return out;
}

}  // namespace dismantle::bench
