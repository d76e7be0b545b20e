/// Bytes as text.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "dismantle/export.h"

namespace dismantle {

/// RFC 4648, section 4, with padding.
DISMANTLE_API std::string base64(std::span<const std::uint8_t> bytes);

/// The bytes of numbers in the order of this machine.
template <class Scalar>
std::string base64_of(const std::vector<Scalar>& values) {
  std::vector<std::uint8_t> bytes(values.size() * sizeof(Scalar));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return base64(bytes);
}

}  // namespace dismantle
