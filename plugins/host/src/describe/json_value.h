/// Parameter values in JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "dismantle/parameters.h"

namespace dismantle {

using Json = nlohmann::ordered_json;

inline Json json_value(const ParamValue& value);

/// In the form of the YAML: {"type": ..., options, parameters}.
inline Json json_value(const PluginChoice& choice) {
  Json json = {{"type", choice.type}};
  for (const ParamSet* set : {&choice.options, &choice.parameters})
    for (const auto& [name, value] : *set) json[name] = json_value(value);
  return json;
}

inline Json json_value(const ParamValue& value) {
  if (const auto* one = std::get_if<PluginChoice>(&value)) return json_value(*one);
  if (const auto* many = std::get_if<std::vector<PluginChoice>>(&value)) {
    Json json = Json::array();
    for (const auto& choice : *many) json.push_back(json_value(choice));
    return json;
  }
  return std::visit(
      [](const auto& v) {
        using V = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<V, PluginChoice> || std::is_same_v<V, std::vector<PluginChoice>>)
          return Json();
        else
          return Json(v);
      },
      value);
}

}  // namespace dismantle
