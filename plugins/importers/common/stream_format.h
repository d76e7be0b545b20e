/// The byte stream from the reader program to the plugin. Both run on one machine; numbers have its byte order.
///
///   magic, then records: u8 tag, u32 length of the payload, payload. Strings in a payload: u32 length, bytes.
///
/// The reader program is not trusted: the file that it read may have corrupted it. So every length has a limit that is
/// checked before memory is allocated for it (input_limits.h).
#pragma once

#include <cstdint>

#include "input_limits.h"

namespace dismantle::reader_process {

inline constexpr char kMagic[8] = {'D', 'S', 'M', 'R', 'E', 'A', 'D', '2'};

enum class Tag : std::uint8_t {
  unit = 'U',       ///< text: the length unit of all coordinates
  phase = 'S',      ///< text, u32 done, u32 total: progress
  warning = 'W',    ///< text
  note = 'N',       ///< text: nothing is wrong
  body = 'B',       ///< text name, u32 number of parents, their names, u32 number of instances, their ids, text
                    ///< product, u8 has colour, 4 x u8 RGBA, text problem, u8 by meaning, u64 vertices, u64 triangles
  vertices = 'V',   ///< 3 doubles each, of the last body
  triangles = 'T',  ///< 3 x u32 each, of the last body
  failure = 'E',    ///< u8 Failure, text
  end = 'Z',        ///< u32 number of bodies
};

enum class Failure : std::uint8_t { unreadable = 1, out_of_memory = 2, too_many_triangles = 3 };

}  // namespace dismantle::reader_process
