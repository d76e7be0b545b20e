#include "dismantle/plan_io/csv_text.h"

#include "export/dot_text.h"

namespace dismantle {

std::string csv_field(const std::string& raw) {
  const std::string text = utf8_text(raw);
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

}  // namespace dismantle
