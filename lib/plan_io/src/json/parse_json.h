/// Text to json, strictly.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace dismantle {

/// A key that stands twice in one object is an error, since the library would keep the last silently.
/// @throws InputError naming `source`.
nlohmann::ordered_json parse_json(const std::string& text, const std::string& source);

}  // namespace dismantle
