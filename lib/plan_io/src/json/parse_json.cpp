#include "json/parse_json.h"

#include <fmt/format.h>

#include <set>
#include <vector>

#include "dismantle/errors.h"

namespace dismantle {

nlohmann::ordered_json parse_json(const std::string& text, const std::string& source) {
  std::vector<std::set<std::string>> keys;
  const auto watch = [&](int, nlohmann::ordered_json::parse_event_t event, nlohmann::ordered_json& parsed) {
    if (event == nlohmann::ordered_json::parse_event_t::object_start) keys.emplace_back();
    if (event == nlohmann::ordered_json::parse_event_t::object_end) keys.pop_back();
    if (event == nlohmann::ordered_json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second)
      throw InputError(source, fmt::format("the key '{}' stands twice in one object", parsed.get<std::string>()));
    return true;
  };
  try {
    return nlohmann::ordered_json::parse(text, watch);
  } catch (const nlohmann::ordered_json::exception& e) {
    std::string what = e.what();  // "[json.exception.parse_error.101] parse error at line 3, column 7: ..."
    if (const auto end = what.find("] "); end != std::string::npos) what.erase(0, end + 2);
    throw InputError(source, "not valid JSON: " + what);
  }
}

}  // namespace dismantle
