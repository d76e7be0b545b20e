#include "colour.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

namespace dismantle::app {

bool wants_colour(std::FILE* stream) {
  const char* no_colour = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  if (no_colour != nullptr && *no_colour != '\0') return false;
  if (terminal == nullptr || std::string_view(terminal) == "dumb") return false;
  return ::isatty(::fileno(stream)) == 1;
}

std::string coloured(std::FILE* stream, Colour colour, std::string_view text) {
  if (!wants_colour(stream)) return std::string(text);
  const int code = colour == Colour::red ? 31 : colour == Colour::yellow ? 33 : 32;
  return fmt::format("\x1b[1;{}m{}\x1b[0m", code, text);
}

}  // namespace dismantle::app
