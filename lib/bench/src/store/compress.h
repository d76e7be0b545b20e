/// Compression of plans, which are long and repetitive.
#pragma once

#include <string>
#include <string_view>

namespace dismantle::bench {

/// zlib format. @throws Error.
std::string compressed(std::string_view bytes);
/// `size`: of the result, bytes. @throws Error when `bytes` is not a result of compressed().
std::string expanded(std::string_view bytes, std::size_t size);

}  // namespace dismantle::bench
