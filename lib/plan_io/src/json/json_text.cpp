#include "json/json_text.h"

#include <fmt/format.h>

#include <cmath>

#include "dismantle/errors.h"

namespace dismantle {
namespace {

using Json = nlohmann::ordered_json;

bool holds_container(const Json& value) {
  for (const auto& item : value)
    if (item.is_structured()) return true;
  return false;
}

std::string quoted(const std::string& text) { return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace); }

void write(const Json& value, std::size_t depth, std::string& out) {
  if (value.is_number_float()) {
    out += number_text(value.get<double>());
    return;
  }
  if (value.is_binary()) {
    out.append(value.get_binary().begin(), value.get_binary().end());
    return;
  }
  if (!value.is_structured()) {
    out += value.dump(-1, ' ', false, Json::error_handler_t::replace);
    return;
  }
  const bool object = value.is_object();
  const bool lines = holds_container(value);
  out += object ? '{' : '[';
  bool first = true;
  for (auto it = value.begin(); it != value.end(); ++it) {
    if (!first) out += ',';
    if (lines)
      out.append(1, '\n').append(2 * (depth + 1), ' ');
    else if (!first)
      out += ' ';
    first = false;
    if (object) out += quoted(it.key()) + ": ";
    write(it.value(), depth + 1, out);
  }
  if (lines) out.append(1, '\n').append(2 * depth, ' ');
  out += object ? '}' : ']';
}

}  // namespace

std::string number_text(double x) {
  if (!std::isfinite(x)) throw Error("a number that is not finite cannot be written as JSON");
  return x == 0 ? "0" : fmt::format("{}", x);
}

std::string json_text(const Json& value) {
  std::string out;
  write(value, 0, out);
  return out;
}

}  // namespace dismantle
