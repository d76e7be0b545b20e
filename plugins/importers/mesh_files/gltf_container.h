/// The container of glTF: JSON, as a text file or as the first chunk of a GLB file.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace dismantle::mesh_files {

struct GltfContainer {
  nlohmann::json json;  ///< discarded: there is none
  std::string binary;   ///< second chunk of a GLB file
  bool has_binary = false;
};

/// @throws InputError when the file cannot be read, or is a GLB file that is cut off.
GltfContainer read_gltf_container(const std::filesystem::path& file, bool with_binary = true);

/// The file that a URI of `file` names; percent-encoded characters are decoded. Not checked.
std::filesystem::path file_of_uri(const std::string& uri, const std::filesystem::path& file);

/// Buffers beside `file` that may_read_referenced() allows. Empty for broken files.
std::vector<std::filesystem::path> buffers_of_gltf(const std::filesystem::path& file);

}  // namespace dismantle::mesh_files
