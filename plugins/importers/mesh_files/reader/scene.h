/// Reads files with several parts: glTF, 3MF, DAE, and with assimp glTF 1.
#pragma once

#include <filesystem>

#include "parts_of_file.h"

namespace dismantle::mesh_files {

/// One part per mesh at each of its places, transforms applied, units of the file.
/// @throws InputError whose text begins with the file. assimp itself may crash, hang or use all memory.
PartsOfFile read_scene(const std::filesystem::path& file);

}  // namespace dismantle::mesh_files
