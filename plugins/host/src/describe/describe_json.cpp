#include <nlohmann/json.hpp>

#include "describe/facts.h"
#include "describe/json_value.h"
#include "dismantle/host/describe.h"

namespace dismantle {
namespace {

Json capabilities(const Capabilities& c) {
  return {{"dynamics", c.dynamics}, {"contacts", c.contacts}, {"distance", c.distance}, {"max_moving", c.max_moving}};
}

Json parameter(const ParamSpec& spec, const Registry& registry) {
  Json json = {{"name", spec.name}, {"type", type_name(spec)}};
  if (!spec.unit.empty()) json["unit"] = spec.unit;
  if (spec.required)
    json["required"] = true;
  else
    json["default"] = json_value(spec, spec.fallback, registry);
  if (spec.min) json["min"] = *spec.min;
  if (spec.min && spec.min_open) json["min_open"] = true;
  if (spec.max) json["max"] = *spec.max;
  if (spec.max && spec.max_open) json["max_open"] = true;
  for (const auto& choice : spec.choices) json["choices"].push_back({{"name", choice.name}, {"doc", choice.doc}});
  for (const auto& option : spec.options)
    json[option.advanced ? "advanced_options" : "options"].push_back(parameter(option, registry));
  json["doc"] = spec.doc;
  return json;
}

}  // namespace

std::string describe_json(const RegisteredType& registered, const Registry& registry) {
  const PluginType& type = registered.type;
  const PluginFile& file = *registered.file;
  Json json = {
      {"id", type.id}, {"kind", to_string(type.kind)}, {"summary", type.summary}, {"source", type.traits.source}};
  if (type.kind == PluginKind::path_planner || type.kind == PluginKind::transfer_planner)
    json["needs"] = capabilities(type.traits.needs);
  if (type.kind == PluginKind::simulator) json["provides"] = capabilities(type.traits.provides);
  for (const char* key : {"parameters", "advanced"}) json[key] = Json::array();
  for (const auto& spec : type.params)
    json[spec.advanced ? "advanced" : "parameters"].push_back(parameter(spec, registry));
  if (!registered.preset_of.empty())
    json["preset"] = {{"of", registered.preset_of}, {"file", registered.preset_file.string()}};
  json["plugin"] = {{"id", file.id},   {"version", file.version},    {"licence", file.licence},
                    {"url", file.url}, {"file", file.path.string()}, {"built_in", file.built_in}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace dismantle
