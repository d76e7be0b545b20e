/// Whole files as text.
#pragma once

#include <filesystem>
#include <string>

#include "dismantle/export.h"

namespace dismantle {

/// The bytes of a file, which may be a pipe. @throws InputError naming the file and the reason.
DISMANTLE_API std::string read_file(const std::filesystem::path& file);

}  // namespace dismantle
