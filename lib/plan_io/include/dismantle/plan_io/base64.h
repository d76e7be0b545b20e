/// Bytes as text.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "dismantle/export.h"

namespace dismantle {

/// RFC 4648, section 4, with padding.
DISMANTLE_API std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace dismantle
