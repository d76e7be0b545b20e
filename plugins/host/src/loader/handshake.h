/// Decides from the plugin header alone whether a plugin is compatible with this host.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dismantle/plugin/abi.h"

namespace dismantle {

/// Each differing item of two ABI tags, with both values: "eigen_max_align_bytes is 32 in the plugin, 16 here".
std::vector<std::string> tag_differences(std::string_view plugin, std::string_view host);

/// Reads and checks the header in `bytes`, the bytes of its symbol. @throws PluginError that names `file`, the
/// differing item, both values and what to rebuild.
PluginHeader accept_header(const std::vector<std::uint8_t>& bytes, const std::string& file);

}  // namespace dismantle
