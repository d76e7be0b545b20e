/// Names of the objects in a 3MF file, which assimp leaves out.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace dismantle::mesh_files {

/// Object id -> its `name` attribute, of all objects that have one. Empty when the file is no 3MF archive.
std::map<std::string, std::string> object_names_3mf(const std::filesystem::path& file);

/// The same from the text of a .model file; adds to `names`.
void add_object_names(const std::string& xml, std::map<std::string, std::string>& names);

}  // namespace dismantle::mesh_files
