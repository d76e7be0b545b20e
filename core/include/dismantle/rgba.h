/// The colour of a part as its file gives it.
#pragma once

#include <cstdint>

namespace dismantle {

/// sRGB, 8 bits a channel, as in "#rrggbb"; a = opacity, 255 = opaque.
struct Rgba {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
  bool operator==(const Rgba&) const = default;
};

}  // namespace dismantle
