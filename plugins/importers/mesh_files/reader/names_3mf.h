/// Reads what assimp ignores in a 3MF file: the names of objects and the unit.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace dismantle::mesh_files {

struct Facts3mf {
  std::map<std::string, std::string> names;  ///< object id -> `name` attribute, if the object has one
  std::string unit;                          ///< "mm", "cm", "m", "inch", "foot", "micron"; empty: unknown
};

/// Empty when the file is not a 3MF archive.
Facts3mf facts_of_3mf(const std::filesystem::path& file);

/// Unit of a .model file; millimetres by default (3MF core specification, 3.4).
std::string unit_of_model(const std::string& xml);

/// Adds the object names in the text of a .model file to `names`.
void add_object_names(const std::string& xml, std::map<std::string, std::string>& names);

}  // namespace dismantle::mesh_files
