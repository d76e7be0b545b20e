/// Reads 3MF files.
#pragma once

#include <filesystem>

#include "parts_of_file.h"

namespace dismantle::mesh_files {

/// Each mesh object that a build item places is a part, components and objects of other model files included.
/// @throws InputError whose text begins with the file.
PartsOfFile read_3mf(const std::filesystem::path& file);

}  // namespace dismantle::mesh_files
