/// Text to json, strictly.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace dismantle {

/// In a list `notes`, an object `data` belongs to a third party: it becomes a binary value, its text byte for byte.
/// A duplicate key in an object is an error, because the library would silently keep the last one.
/// @throws InputError naming `source`.
nlohmann::ordered_json parse_json(const std::string& text, const std::string& source);

}  // namespace dismantle
