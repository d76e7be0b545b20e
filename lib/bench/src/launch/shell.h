/// Quoting for command lines that people or scripts run.
#pragma once

#include <string>

namespace dismantle::bench {

/// `text` as one word of a POSIX shell, whatever characters it contains.
inline std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace dismantle::bench
