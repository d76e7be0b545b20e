/// Reads glTF 2.0.
#pragma once

#include <filesystem>

#include "parts_of_file.h"

namespace dismantle::mesh_files {

/// Each node with a mesh is a part, each of its instances too. Skins and morph targets are applied as the file has
/// them.
/// @throws InputError whose text begins with the file.
PartsOfFile read_gltf(const std::filesystem::path& file);

}  // namespace dismantle::mesh_files
