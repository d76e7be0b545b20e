/// Coloured output on terminals.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace dismantle::app {

enum class Colour { red, yellow, green };

/// True if `stream` is a terminal with colours and NO_COLOR is not set (https://no-color.org).
bool wants_colour(std::FILE* stream);
/// `text` in bold and `colour` if wants_colour(stream), else unchanged.
std::string coloured(std::FILE* stream, Colour colour, std::string_view text);

}  // namespace dismantle::app
