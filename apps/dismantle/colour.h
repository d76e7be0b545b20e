/// Colours, where the reader has a terminal and wants them.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace dismantle::app {

enum class Colour { red, yellow, green };

/// Is `stream` a terminal that shows colours, and is NO_COLOR not set (https://no-color.org)?
bool wants_colour(std::FILE* stream);
/// `text` in bold and that colour, or as it is.
std::string coloured(std::FILE* stream, Colour colour, std::string_view text);

}  // namespace dismantle::app
