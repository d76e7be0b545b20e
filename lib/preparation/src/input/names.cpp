// Part names: valid UTF-8, not empty, unique.
#include <fmt/format.h>

#include <cstddef>
#include <map>
#include <set>

#include "dismantle/preparation/read_input.h"

namespace dismantle {
namespace {

/// Length of the well-formed UTF-8 sequence at `i` (Unicode table 3-7), 0 when there is none.
std::size_t utf8_length(std::string_view s, std::size_t i) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(s[k]); };
  const auto continues = [&](std::size_t k, unsigned lo = 0x80, unsigned hi = 0xBF) {
    return k < s.size() && byte(k) >= lo && byte(k) <= hi;
  };
  const unsigned c = byte(i);
  if (c < 0x80) return 1;
  if (c >= 0xC2 && c <= 0xDF) return continues(i + 1) ? 2 : 0;
  if (c >= 0xE0 && c <= 0xEF) {
    const unsigned lo = c == 0xE0 ? 0xA0 : 0x80, hi = c == 0xED ? 0x9F : 0xBF;
    return continues(i + 1, lo, hi) && continues(i + 2) ? 3 : 0;
  }
  if (c >= 0xF0 && c <= 0xF4) {
    const unsigned lo = c == 0xF0 ? 0x90 : 0x80, hi = c == 0xF4 ? 0x8F : 0xBF;
    return continues(i + 1, lo, hi) && continues(i + 2) && continues(i + 3) ? 4 : 0;
  }
  return 0;
}

}  // namespace

std::string valid_utf8(std::string_view bytes) {
  std::string out;
  out.reserve(bytes.size());
  for (std::size_t i = 0; i < bytes.size();) {
    const std::size_t n = utf8_length(bytes, i);
    if (n == 0) {
      out += "\xEF\xBF\xBD";
      ++i;
    } else if (n == 1 && (static_cast<unsigned char>(bytes[i]) < 0x20 || bytes[i] == 0x7F)) {
      out += '_';
      ++i;
    } else if (n == 2 && bytes[i] == '\xC2' && static_cast<unsigned char>(bytes[i + 1]) < 0xA0) {
      out += '_';  // terminals interpret these as commands
      i += 2;
    } else {
      out += bytes.substr(i, n);
      i += n;
    }
  }
  return out;
}

void make_names_unique(std::vector<RawPart>& parts, std::vector<std::string>& warnings) {
  std::set<std::string> reserved;  // a renamed part never takes a name of the input
  for (auto& part : parts) {
    if (part.name.empty()) part.name = "part";
    reserved.insert(part.name);
  }
  std::set<std::string> used;
  std::map<std::string, int> last;  // number by which a part of this name was renamed
  std::size_t renamed = 0;
  std::string first;
  for (auto& part : parts) {
    if (used.insert(part.name).second) continue;
    std::string name;
    for (int& n = last.try_emplace(part.name, 1).first->second;;) {
      name = fmt::format("{}#{}", part.name, ++n);
      if (!reserved.count(name) && !used.count(name)) break;
    }
    if (renamed++ == 0)
      first = fmt::format("'{}' ({}) is now '{}'", part.name, part.file.empty() ? "no file" : part.file, name);
    part.name = name;
    used.insert(name);
  }
  if (renamed == 0) return;
  warnings.push_back(
      renamed == 1 ? fmt::format("1 part has the name of another one: {}", first)
                   : fmt::format("{} parts have the names of others, and got numbers: the first, {}", renamed, first));
}

}  // namespace dismantle
