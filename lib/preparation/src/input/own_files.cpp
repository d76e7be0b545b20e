#include "input/own_files.h"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace dismantle {

bool is_own_animation(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  char magic[4] = {};
  std::uint32_t head[4] = {};  // version, length of the file, length of the first chunk, its type
  if (!in.read(magic, 4) || std::memcmp(magic, "glTF", 4) != 0) return false;
  if (!in.read(reinterpret_cast<char*>(head), sizeof head) || head[3] != 0x4E4F534A) return false;  // "JSON"
  if (head[2] > 256u << 20) return false;  // bytes; animations of thousands of steps stay far below
  std::error_code ec;
  if (head[2] > std::filesystem::file_size(file, ec) || ec) return false;
  std::string text(head[2], '\0');
  if (!in.read(text.data(), static_cast<std::streamsize>(text.size()))) return false;
  if (text.find("\"dismantle ") == std::string::npos) return false;
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("asset") || !json["asset"].is_object()) return false;
  const auto generator = json["asset"].value("generator", nlohmann::json());
  return generator.is_string() && generator.get<std::string>().starts_with("dismantle ") && json.contains("scenes");
}

bool is_own_output(const std::filesystem::path& folder) {
  std::ifstream in(folder / "prepare.json", std::ios::binary);
  std::string begin(200, '\0');  // write_prepared() writes the format first
  in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin.find("\"dismantle.prepare\"") != std::string::npos;
}

}  // namespace dismantle
