/// Limits of input files, shared by all importers. They are far above any assembly that can be planned. They stop small
/// files that multiply their content, and broken streams, from using all memory.
#pragma once

#include <cstdint>

namespace dismantle::reader_process {

/// Exceeding a limit is an error that names the file.
struct InputLimits {
  std::uint64_t triangles = 100'000'000;  ///< of all bodies together; a small file can use one mesh a million times
  std::uint32_t instances = 1'000'000;    ///< nodes, products and bodies; nesting can multiply them
  std::uint32_t nesting = 64;             ///< levels of the product structure
  std::uint32_t record = 1u << 20;        ///< bytes of one record of the stream
  std::uint32_t text = 1u << 12;          ///< bytes of one string of the stream
};
inline constexpr InputLimits kInputLimits;

}  // namespace dismantle::reader_process
