/// Fields of CSV files (RFC 4180).
#pragma once

#include <string>

#include "export/dot_text.h"

namespace dismantle {

/// UTF-8; quoted where RFC 4180 requires it.
inline std::string csv_field(const std::string& raw) {
  const std::string text = utf8_text(raw);
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

}  // namespace dismantle
