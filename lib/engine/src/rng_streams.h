/// Random streams of a run, one per purpose, so that draws of one never shift those of another.
#pragma once

#include <cstdint>

namespace dismantle {

/// Arguments of Rng::fork(); the values are the names in ASCII.
enum RngStream : std::uint64_t {
  sequence_stream = 0x73657175656e6365,  ///< the sequence planner; attempts fork by their key
  transfer_stream = 0x7472616e73666572,
  force_stream = 0x666f726365,  ///< the sequence planner between forced steps
};

}  // namespace dismantle
