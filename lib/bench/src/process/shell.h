/// Words of a command line for people or scripts to run.
#pragma once

#include <string>

namespace dismantle::bench {

/// One word for a POSIX shell, whatever is in it.
inline std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace dismantle::bench
