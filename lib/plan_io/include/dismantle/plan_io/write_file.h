/// Atomic replacement of files.
#pragma once

#include <filesystem>
#include <string>

#include "dismantle/export.h"

namespace dismantle {

/// Writes to a temporary file beside `file` and renames it: a reader never sees half a file. @throws Error.
DISMANTLE_API void write_file(const std::filesystem::path& file, const std::string& content);

}  // namespace dismantle
