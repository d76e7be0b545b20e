/// Colours as text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "dismantle/rgba.h"

namespace dismantle {

/// "#rrggbb", without opacity.
std::string to_hex(const Rgba& colour);
/// Of "#rrggbb", opaque; nothing when `text` is not that.
std::optional<Rgba> rgba_from_hex(std::string_view text);

}  // namespace dismantle
