/// Reads scenes with assimp and converts them to parts.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dismantle/importer.h"

namespace dismantle::mesh_files {

/// glTF, 3MF, DAE: one part per mesh node, node transforms applied, units of the file.
/// @throws InputError whose text begins with the file. assimp itself may crash, hang or use all memory.
std::vector<RawPart> read_scene(const std::filesystem::path& file);

}  // namespace dismantle::mesh_files
