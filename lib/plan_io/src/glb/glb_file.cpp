#include "glb/glb_file.h"

#include <bit>
#include <limits>
#include <string>

#include "dismantle/errors.h"

namespace dismantle {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

void append_u32(std::vector<std::uint8_t>& out, std::size_t value) {
  if (value > std::numeric_limits<std::uint32_t>::max())
    throw Error("the file would be larger than the 4 GB that a .glb file can hold");
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

}  // namespace

std::vector<std::uint8_t> pack_glb(const GlbJson& json, std::vector<std::uint8_t> binary) {
  std::string text = json.dump(-1, ' ', false, GlbJson::error_handler_t::replace);
  text.resize((text.size() + 3) & ~std::size_t{3}, ' ');
  binary.resize((binary.size() + 3) & ~std::size_t{3}, 0);
  std::vector<std::uint8_t> out;
  out.reserve(28 + text.size() + binary.size());
  append_u32(out, 0x46546C67);  // "glTF"
  append_u32(out, 2);
  append_u32(out, 12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size()));
  append_u32(out, text.size());
  append_u32(out, 0x4E4F534A);  // "JSON"
  out.insert(out.end(), text.begin(), text.end());
  if (!binary.empty()) {
    append_u32(out, binary.size());
    append_u32(out, 0x004E4942);  // "BIN"
    out.insert(out.end(), binary.begin(), binary.end());
  }
  return out;
}

}  // namespace dismantle
