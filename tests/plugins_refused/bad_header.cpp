// A header in which BAD_ITEM differs.
#include "dismantle/plugin/abi.h"
#include "ends_the_process.h"

namespace {

int registers_nothing(void*, char*, std::size_t) noexcept { return 0; }

template <std::size_t N>
[[maybe_unused]] constexpr void fill(char (&field)[N]) {
  for (char& c : field) c = 'x';
}

constexpr dismantle::PluginHeader bad_header() {
  dismantle::PluginHeader header;
  header.magic = dismantle::kPluginMagic;
  header.header_size = sizeof(header);
  header.api_major = dismantle::kPluginApiMajor;
  header.api_minor = dismantle::kPluginApiMinor;
  header.register_types = &registers_nothing;
  BAD_ITEM;
  return header;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const dismantle::PluginHeader dismantle_plugin_header;
constinit const dismantle::PluginHeader dismantle_plugin_header = bad_header();
