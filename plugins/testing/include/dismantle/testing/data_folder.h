/// Where the real assemblies are that some tests read. Those tests are skipped where it does not exist.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace dismantle {

/// $DISMANTLE_DATA; without it, shared/data beside the checkout `source`.
inline std::filesystem::path test_data_folder(const std::filesystem::path& source) {
  if (const char* named = std::getenv("DISMANTLE_DATA"); named != nullptr && *named != '\0') return named;
  return source.parent_path() / "shared" / "data";
}

}  // namespace dismantle
