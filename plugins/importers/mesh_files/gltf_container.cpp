#include "gltf_container.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "dismantle/errors.h"
#include "dismantle/referenced_file.h"

namespace dismantle::mesh_files {

GltfContainer read_gltf_container(const std::filesystem::path& file, bool with_binary) {
  std::ifstream in(file, std::ios::binary);
  std::error_code ec;
  const std::uint64_t whole = std::filesystem::file_size(file, ec);
  if (!in || ec) throw InputError(file.string(), "cannot be opened");
  char head[20] = {};  // of the file, and of the first chunk
  in.read(head, sizeof head);
  std::uint32_t first = 0;
  std::memcpy(&first, head + 12, sizeof first);
  const bool less = !with_binary && std::string_view(head, 4) == "glTF";
  const std::uint64_t size = less ? std::min<std::uint64_t>(whole, sizeof head + std::uint64_t{first}) : whole;
  std::string bytes(size, '\0');
  in.clear();
  in.seekg(0);
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size))) throw InputError(file.string(), "cannot be read");
  GltfContainer out;
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  if (!std::string_view(bytes).starts_with("glTF")) {
    out.json = nlohmann::json::parse(bytes, nullptr, false);
    return out;
  }
  constexpr std::uint32_t kJson = 0x4E4F534A, kBinary = 0x004E4942;
  std::size_t at = 12;  // after magic, version, length
  for (int chunk = 0; at + 8 <= size; ++chunk) {
    const std::size_t length = word(at);
    const std::uint32_t kind = word(at + 4);
    at += 8;
    if (length > size - at) throw InputError(file.string(), "the file is cut off: a chunk goes beyond its end");
    if (chunk == 0 && kind == kJson)
      out.json = nlohmann::json::parse(bytes.data() + at, bytes.data() + at + length, nullptr, false);
    if (chunk == 1 && kind == kBinary) {
      out.binary.assign(bytes, at, length);
      out.has_binary = true;
    }
    at += length;
  }
  if (at == 12) throw InputError(file.string(), "the file is cut off: it has no content");
  return out;
}

std::filesystem::path file_of_uri(const std::string& uri, const std::filesystem::path& file) {
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const std::string digits = uri.substr(i + 1, 2);
    char* end = nullptr;
    const long code = uri[i] == '%' && digits.size() == 2 ? std::strtol(digits.c_str(), &end, 16) : 0;
    if (code > 0 && *end == '\0') {
      name += static_cast<char>(code);
      i += 2;
    } else {
      name += uri[i];
    }
  }
  return file.parent_path() / name;
}

std::vector<std::filesystem::path> buffers_of_gltf(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> found;
  try {
    const nlohmann::json json = read_gltf_container(file, false).json;
    if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return found;
    for (const auto& buffer : json["buffers"]) {
      if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
      const std::string uri = buffer["uri"];
      if (uri.starts_with("data:")) continue;
      const std::filesystem::path path = file_of_uri(uri, file);
      if (may_read_referenced(path, file)) found.push_back(path);
    }
  } catch (const InputError&) {
    return {};  // reading the file reports it
  }
  return found;
}

}  // namespace dismantle::mesh_files
