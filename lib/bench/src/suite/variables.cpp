#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "suite/assemblies.h"

namespace dismantle::bench {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> value_of_variable(const std::string& name, const fs::path& suite_file) {
  if (const char* value = std::getenv(name.c_str()); value != nullptr && *value != '\0') return value;
  if (name != "DISMANTLE_DATA") return std::nullopt;
  std::error_code error;
  const fs::path home = fs::absolute(suite_file, error).parent_path();
  for (const fs::path& base : {fs::current_path(error), home / ".." / ".."}) {
    const fs::path data = fs::weakly_canonical(base / ".." / "shared" / "data", error);
    if (!error && fs::is_directory(data, error)) return data.string();
  }
  return std::nullopt;
}

}  // namespace

bool expand_variables(std::string& text, const fs::path& suite_file) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] != '$') {
      out += text[i++];
      continue;
    }
    const bool braced = i + 1 < text.size() && text[i + 1] == '{';
    const std::size_t begin = i + (braced ? 2 : 1);
    std::size_t end = begin;
    while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_')) ++end;
    const std::string name = text.substr(begin, end - begin);
    const auto value = value_of_variable(name, suite_file);
    if (!value) {
      text = name;
      return false;
    }
    out += *value;
    i = end + (braced && end < text.size() && text[end] == '}' ? 1 : 0);
  }
  text = out;
  return true;
}

}  // namespace dismantle::bench
