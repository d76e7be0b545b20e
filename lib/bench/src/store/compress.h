/// Plans are long and repeat themselves.
#pragma once

#include <string>
#include <string_view>

namespace dismantle::bench {

/// zlib format. @throws Error.
std::string compressed(std::string_view bytes);
/// `size`: of the result. @throws Error when the bytes are not what compressed() made.
std::string expanded(std::string_view bytes, std::size_t size);

}  // namespace dismantle::bench
