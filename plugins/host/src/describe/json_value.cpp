#include "describe/json_value.h"

namespace dismantle {
namespace {

void add(Json& json, const std::vector<ParamSpec>& specs, const ParamSet& values, const Registry& registry) {
  for (const ParamSpec& spec : specs) {
    const auto it = values.find(spec.name);
    if (it == values.end() || (spec.advanced && it->second == spec.fallback)) continue;
    (spec.advanced ? json["advanced"] : json)[spec.name] = json_value(spec, it->second, registry);
  }
}

Json json_choice(const ParamSpec& spec, const PluginChoice& choice, const Registry& registry) {
  Json json = {{"type", choice.type}};
  add(json, spec.options, choice.options, registry);
  if (const RegisteredType* type = registry.lookup(spec.plugin_kind, choice.type); type != nullptr)
    add(json, type->type.params, choice.parameters, registry);
  return json;
}

}  // namespace

Json json_value(const ParamSpec& spec, const ParamValue& value, const Registry& registry) {
  if (const auto* b = std::get_if<bool>(&value)) return *b;
  if (const auto* i = std::get_if<std::int64_t>(&value)) return *i;
  if (const auto* d = std::get_if<double>(&value)) return *d;
  if (const auto* s = std::get_if<std::string>(&value)) return *s;
  if (const auto* one = std::get_if<PluginChoice>(&value)) return json_choice(spec, *one, registry);
  Json json = Json::array();
  for (const PluginChoice& choice : std::get<std::vector<PluginChoice>>(value))
    json.push_back(json_choice(spec, choice, registry));
  return json;
}

}  // namespace dismantle
