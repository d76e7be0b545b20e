/// Files that a STEP file refers to.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dismantle::step_import {

struct ExternalFiles {
  std::vector<std::filesystem::path> read;  ///< in the folder of the file; also those that they refer to
  std::vector<std::string> refused;         ///< names of files that are there and must not be opened
};

/// Searches the text of `file`, and of the files that it finds, for external references. Never throws for broken files.
ExternalFiles external_files(const std::filesystem::path& file);

}  // namespace dismantle::step_import
