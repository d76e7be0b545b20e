/// What assimp leaves out of a 3MF file: the names of its objects, and the unit.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace dismantle::mesh_files {

struct Facts3mf {
  std::map<std::string, std::string> names;  ///< object id -> its `name` attribute, of all objects that have one
  std::string unit;                          ///< "mm", "cm", "m", "inch", "foot", "micron"; empty: unknown
};

/// Nothing when the file is no 3MF archive.
Facts3mf facts_of_3mf(const std::filesystem::path& file);

/// Of a .model file; millimetres where it says nothing (3MF core specification, 3.4).
std::string unit_of_model(const std::string& xml);

/// The same from the text of a .model file; adds to `names`.
void add_object_names(const std::string& xml, std::map<std::string, std::string>& names);

}  // namespace dismantle::mesh_files
