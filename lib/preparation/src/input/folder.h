/// What lies in a folder of parts.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "dismantle/importer.h"

namespace dismantle {

/// Extension of a file, lower-case, without dot.
std::string lower_extension(const std::filesystem::path& file);

struct FolderContents {
  std::vector<std::filesystem::path> meshes;  ///< in natural order
  std::vector<RawPart> rest;                  ///< what may be input and is not read, each with its problem
  std::vector<std::filesystem::path> folders;  ///< those of `rest`, in natural order
  bool sub_folders = false;
};

/// Files of other formats that often lie beside meshes and hold no geometry are skipped. Sub-folders count as `rest` if
/// a file that `can_read` lies in them, at any depth. `readable`: which formats can be read, for messages.
/// @throws InputError when the folder cannot be read.
FolderContents contents_of(const std::filesystem::path& folder,
                           const std::function<bool(const std::string& extension)>& can_read,
                           const std::string& readable);

}  // namespace dismantle
