/// Parameter values in JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "dismantle/host/registry.h"
#include "dismantle/parameters.h"

namespace dismantle {

using Json = nlohmann::ordered_json;

/// `value` of the parameter `spec` in the form of the YAML: a choice of a plugin is {"type": ..., options, parameters,
/// "advanced": {those that differ from their defaults}}.
Json json_value(const ParamSpec& spec, const ParamValue& value, const Registry& registry);

}  // namespace dismantle
