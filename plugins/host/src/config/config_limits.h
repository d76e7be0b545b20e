/// Limits of a configuration. A file beyond them is damaged or hostile and is refused before it costs time or memory.
#pragma once

#include <cstddef>
#include <cstdint>

namespace dismantle {

struct ConfigLimits {
  std::uintmax_t bytes = std::uintmax_t{1} << 20;  ///< of one file
  std::size_t nodes = 100'000;                     ///< of one file; nodes of an alias count at each use
  std::size_t depth = 64;                          ///< levels of maps and lists
  std::size_t files = 32;                          ///< that extend each other
  unsigned plugins = 16;                           ///< nesting levels of plugins in plugins
};
inline constexpr ConfigLimits kConfigLimits;

}  // namespace dismantle
