#include "loader/handshake.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "dismantle/errors.h"
#include "dismantle/plugin.h"

namespace dismantle {
namespace {

std::map<std::string, std::string> items_of(std::string_view tag) {
  std::map<std::string, std::string> items;
  std::string key, value;
  bool in_value = false;
  for (const char c : tag) {
    if (c == ';') {
      items.emplace(key, value);
      key.clear(), value.clear();
      in_value = false;
    } else if (c == '=' && !in_value) {
      in_value = true;
    } else {
      (in_value ? value : key) += c;
    }
  }
  if (!key.empty()) items.emplace(key, value);
  return items;
}

/// Tells the user what to do about a differing item.
std::string remedy(const std::string& key) {
  if (key == "eigen") return "rebuild the plugin with the Eigen that Dismantle was built with";
  if (key == "eigen_max_align_bytes")
    return "rebuild the plugin without -march=native and the like, or with -DEIGEN_MAX_ALIGN_BYTES set to the value "
           "here";
  if (key == "stdlib_debug") return "rebuild the plugin with the same setting of _GLIBCXX_DEBUG";
  if (key == "cxx11_strings") return "rebuild the plugin with the same _GLIBCXX_USE_CXX11_ABI";
  if (key == "layout") return "rebuild the plugin against the headers of this Dismantle";
  return "rebuild the plugin with the compiler and libraries that Dismantle was built with";
}

std::string version_text(unsigned major, unsigned minor) { return fmt::format("{}.{}", major, minor); }

template <std::size_t N>
bool terminated(const char (&field)[N]) {
  return std::memchr(field, '\0', N) != nullptr;
}

}  // namespace

std::vector<std::string> tag_differences(std::string_view plugin, std::string_view host) {
  const auto theirs = items_of(plugin);
  const auto ours = items_of(host);
  std::vector<std::string> differences;
  const auto shown = [](const std::map<std::string, std::string>& items, const std::string& key) {
    const auto it = items.find(key);
    return it == items.end() ? std::string("not stated") : it->second;
  };
  auto keys = ours;
  keys.insert(theirs.begin(), theirs.end());
  for (const auto& [key, value] : keys) {
    const std::string a = shown(theirs, key), b = shown(ours, key);
    if (a != b) differences.push_back(fmt::format("{} is {} in the plugin, {} here ({})", key, a, b, remedy(key)));
  }
  if (differences.empty() && plugin != host)
    differences.emplace_back("the ABI tag is spelled differently (rebuild the plugin)");
  return differences;
}

PluginHeader accept_header(const std::vector<std::uint8_t>& bytes, const std::string& file) {
  PluginHeader header;
  const auto fail = [&file](const std::string& problem) { throw PluginError(file, problem); };
  const std::size_t fixed = offsetof(PluginHeader, abi_tag);  // magic, size, API version
  if (bytes.size() < fixed)
    fail(fmt::format("plugin header has {} bytes, expected {}; rebuild the plugin", bytes.size(), sizeof(header)));
  std::memcpy(static_cast<void*>(&header), bytes.data(), fixed);
  if (header.magic != kPluginMagic)
    fail(
        fmt::format("magic is {:#010x} in the plugin, {:#010x} here: '{}' is no header of a Dismantle plugin; rebuild "
                    "it with DISMANTLE_PLUGIN",
                    header.magic, kPluginMagic, kPluginHeaderSymbol));
  const std::string theirs = version_text(header.api_major, header.api_minor);
  const std::string ours = version_text(kPluginApiMajor, kPluginApiMinor);
  if (header.api_major > kPluginApiMajor)
    fail(
        fmt::format("plugin API is {} in the plugin, {} here: the plugin is newer; update Dismantle, or rebuild the "
                    "plugin against this one",
                    theirs, ours));
  if (header.api_major < kPluginApiMajor)
    fail(fmt::format("plugin API is {} in the plugin, {} here: the plugin is older; rebuild it against this Dismantle",
                     theirs, ours));
  if (header.api_minor > kPluginApiMinor)
    fail(
        fmt::format("plugin API is {} in the plugin, {} here: the plugin may use functions that this Dismantle does "
                    "not have; update Dismantle, or rebuild the plugin against this one",
                    theirs, ours));
  if (header.header_size < sizeof(header) || bytes.size() < sizeof(header))
    fail(fmt::format("header size is {} in the plugin, {} here; rebuild the plugin",
                     std::min<std::size_t>(header.header_size, bytes.size()), sizeof(header)));
  std::memcpy(static_cast<void*>(&header), bytes.data(), sizeof(header));
  if (!terminated(header.abi_tag) || !terminated(header.id) || !terminated(header.version) ||
      !terminated(header.licence) || !terminated(header.url))
    fail("plugin header is damaged: a text in it does not end; rebuild the plugin");
  if (header.id[0] == '\0' || header.version[0] == '\0' || header.licence[0] == '\0')
    fail("plugin id, version and licence must not be empty in DISMANTLE_PLUGIN");
  std::string all;
  for (const auto& difference : tag_differences(header.abi_tag, abi::kTag.data))
    all += (all.empty() ? "" : "; ") + difference;
  if (!all.empty()) fail("built in a way that does not fit: " + all);
  header.register_types = nullptr;  // not relocated: only the loaded library has the real one
  return header;
}

}  // namespace dismantle
