/// Parameter values in JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "dismantle/parameters.h"

namespace dismantle {

using Json = nlohmann::ordered_json;

inline Json json_value(const ParamValue& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

}  // namespace dismantle
