/// Reads DAE files (COLLADA 1.4 and 1.5).
#pragma once

#include <filesystem>

#include "parts_of_file.h"

namespace dismantle::mesh_files {

/// Each node of the shown scene that uses geometry is a part at each of its places, in the unit and the axes of the
/// file. Uses of what the file lacks, or of what is not read, are parts with a problem.
/// @throws InputError whose text begins with the file.
PartsOfFile read_dae(const std::filesystem::path& file);

}  // namespace dismantle::mesh_files
