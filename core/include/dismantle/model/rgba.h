/// The colour of a part as its file gives it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "dismantle/export.h"

namespace dismantle {

/// sRGB, 8 bits a channel, as in "#rrggbb"; a = opacity, 255 = opaque.
struct Rgba {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
  bool operator==(const Rgba&) const = default;
};

/// "#rrggbb", without opacity.
DISMANTLE_API std::string to_hex(const Rgba& colour);
/// Of "#rrggbb", opaque; nothing when `text` is not that.
DISMANTLE_API std::optional<Rgba> rgba_from_hex(std::string_view text);

}  // namespace dismantle
