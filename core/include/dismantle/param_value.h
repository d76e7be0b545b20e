/// Values of parameters: plain ones, and choices of plugins, which have parameters of their own.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "dismantle/export.h"

namespace dismantle {

struct PluginChoice;
/// The value of one parameter.
using ParamValue = std::variant<bool, std::int64_t, double, std::string, PluginChoice, std::vector<PluginChoice>>;
/// Values of parameters by name.
using ParamSet = std::map<std::string, ParamValue>;

/// A plugin type that was chosen: `{type: tunnel_forest, tunnels: 10, after: 30000}` in YAML.
struct DISMANTLE_API PluginChoice {
  std::string type;     ///< id
  ParamSet parameters;  ///< of that type
  ParamSet options;     ///< of the parameter that holds the choice (ParamSpec::options), such as `after`

  bool operator==(const PluginChoice& other) const;
};

/// YAML text that reads as this value; numbers round-trip; independent of the locale. Text has no quotes, except inside
/// a choice of plugins.
DISMANTLE_API std::string to_text(const ParamValue& value);

}  // namespace dismantle
