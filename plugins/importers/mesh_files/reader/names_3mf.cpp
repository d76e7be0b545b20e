#include "names_3mf.h"

#include <minizip/unzip.h>

#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace dismantle::mesh_files {
namespace {

struct Archive {
  explicit Archive(const std::filesystem::path& file) : handle(unzOpen64(file.c_str())) {}
  ~Archive() {
    if (handle) unzClose(handle);
  }
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
  unzFile handle;
};

void put_utf8(std::uint32_t c, std::string& out) {
  if (c < 0x80) {
    out += static_cast<char>(c);
  } else if (c < 0x800) {
    out += static_cast<char>(0xC0 | c >> 6);
    out += static_cast<char>(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    out += static_cast<char>(0xE0 | c >> 12);
    out += static_cast<char>(0x80 | (c >> 6 & 0x3F));
    out += static_cast<char>(0x80 | (c & 0x3F));
  } else if (c < 0x110000) {
    out += static_cast<char>(0xF0 | c >> 18);
    out += static_cast<char>(0x80 | (c >> 12 & 0x3F));
    out += static_cast<char>(0x80 | (c >> 6 & 0x3F));
    out += static_cast<char>(0x80 | (c & 0x3F));
  }
}

/// Attribute text with XML entities resolved.
std::string decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto end = text[i] == '&' ? text.find(';', i) : std::string_view::npos;
    if (end == std::string_view::npos) {
      out += text[i];
      continue;
    }
    const std::string entity(text.substr(i + 1, end - i - 1));
    if (entity == "amp")
      out += '&';
    else if (entity == "lt")
      out += '<';
    else if (entity == "gt")
      out += '>';
    else if (entity == "quot")
      out += '"';
    else if (entity == "apos")
      out += '\'';
    else if (entity.starts_with("#x"))
      put_utf8(static_cast<std::uint32_t>(std::strtoul(entity.c_str() + 2, nullptr, 16)), out);
    else if (entity.starts_with("#"))
      put_utf8(static_cast<std::uint32_t>(std::strtoul(entity.c_str() + 1, nullptr, 10)), out);
    i = end;
  }
  return out;
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Value of an attribute inside a tag; empty when there is none.
std::string attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    std::size_t i = at + name.size();
    if (at == 0 || !is_space(tag[at - 1])) continue;
    while (i < tag.size() && is_space(tag[i])) ++i;
    if (i >= tag.size() || tag[i] != '=') continue;
    ++i;
    while (i < tag.size() && is_space(tag[i])) ++i;
    if (i >= tag.size() || (tag[i] != '"' && tag[i] != '\'')) continue;
    const auto end = tag.find(tag[i], i + 1);
    if (end == std::string_view::npos) return {};
    return decoded(tag.substr(i + 1, end - i - 1));
  }
  return {};
}

}  // namespace

void add_object_names(const std::string& xml, std::map<std::string, std::string>& names) {
  const std::string_view start = "<object";
  for (std::size_t at = xml.find(start); at != std::string::npos; at = xml.find(start, at + 1)) {
    const auto end = xml.find('>', at);
    if (end == std::string::npos) return;
    const std::string_view tag = std::string_view(xml).substr(at + start.size(), end - at - start.size());
    if (tag.empty() || !is_space(tag[0])) continue;
    const std::string id = attribute(tag, "id"), name = attribute(tag, "name");
    if (!id.empty() && !name.empty()) names.emplace(id, name);
  }
}

std::string unit_of_model(const std::string& xml) {
  const std::string_view start = "<model";
  const auto at = xml.find(start);
  const auto end = at == std::string::npos ? at : xml.find('>', at);
  if (end == std::string::npos) return {};
  const std::string unit = attribute(std::string_view(xml).substr(at + start.size(), end - at - start.size()), "unit");
  static const std::map<std::string, std::string> units = {
      {"", "mm"},       {"millimeter", "mm"}, {"centimeter", "cm"}, {"meter", "m"},
      {"inch", "inch"}, {"foot", "foot"},     {"micron", "micron"}};
  const auto found = units.find(unit);
  return found == units.end() ? std::string() : found->second;
}

Facts3mf facts_of_3mf(const std::filesystem::path& file) {
  Facts3mf facts;
  const Archive archive(file);
  if (!archive.handle) return facts;
  for (int state = unzGoToFirstFile(archive.handle); state == UNZ_OK; state = unzGoToNextFile(archive.handle)) {
    char name[1024] = {};
    unz_file_info64 info{};
    if (unzGetCurrentFileInfo64(archive.handle, &info, name, sizeof name - 1, nullptr, 0, nullptr, 0) != UNZ_OK) break;
    if (!std::string_view(name).ends_with(".model") || unzOpenCurrentFile(archive.handle) != UNZ_OK) continue;
    std::string xml;
    std::vector<char> block(1 << 16);
    int n = 0;
    const std::size_t longest = std::size_t{1} << 31;  // bytes: a small archive can expand without limit
    while (xml.size() < longest &&
           (n = unzReadCurrentFile(archive.handle, block.data(), static_cast<unsigned>(block.size()))) > 0)
      xml.append(block.data(), static_cast<std::size_t>(n));
    unzCloseCurrentFile(archive.handle);
    add_object_names(xml, facts.names);
    if (facts.unit.empty()) facts.unit = unit_of_model(xml);
  }
  return facts;
}

}  // namespace dismantle::mesh_files
