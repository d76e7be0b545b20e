#include "export/dot_text.h"

#include <nlohmann/json.hpp>

namespace dismantle {

std::string utf8_text(const std::string& text) {
  using Json = nlohmann::json;
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

std::string dot_quoted(const std::string& text) {
  // Graphviz takes `\"` in every quoted string and expands `\\` in labels.
  std::string out = "\"";
  for (const char c : utf8_text(text)) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  }
  return out + '"';
}

}  // namespace dismantle
