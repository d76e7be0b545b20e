#include <fmt/format.h>

#include "describe/json_value.h"
#include "dismantle/host/config.h"
#include "dismantle/host/describe.h"

namespace dismantle {
namespace {

Json parameter_schema(const ParamSpec& spec) {
  Json json;
  switch (spec.type) {
    case ParamType::boolean:
      json["type"] = "boolean";
      break;
    case ParamType::integer:
      json["type"] = "integer";
      break;
    case ParamType::number:
      json["type"] = "number";
      break;
    case ParamType::text:
      json["type"] = "string";
      break;
    case ParamType::choice:
      json["enum"] = Json::array();
      for (const auto& choice : spec.choices) json["enum"].push_back(choice.name);
      break;
  }
  if (spec.min) json[spec.min_open ? "exclusiveMinimum" : "minimum"] = *spec.min;
  if (spec.max) json[spec.max_open ? "exclusiveMaximum" : "maximum"] = *spec.max;
  json["default"] = json_value(spec.fallback);
  json["description"] = spec.unit.empty() || spec.unit == "1" ? spec.doc : fmt::format("{} [{}]", spec.doc, spec.unit);
  return json;
}

Json object(Json properties) {
  return {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
}

Json properties_of(const std::vector<ParamSpec>& specs) {
  Json properties = Json::object();
  for (const auto& spec : specs) properties[spec.name] = parameter_schema(spec);
  return properties;
}

/// One alternative per type; the default type may leave its id out.
Json plugin_section(const PluginSection& section, const Registry& registry) {
  Json alternatives = Json::array();
  for (const auto* registered : registry.types(section.kind)) {
    const PluginType& type = registered->type;
    Json properties = {{"type", {{"const", type.id}, {"description", type.summary}}}};
    properties.update(properties_of(type.params));
    Json alternative = object(std::move(properties));
    if (type.id != section.default_id) alternative["required"] = {"type"};
    alternatives.push_back(std::move(alternative));
  }
  if (alternatives.empty()) return {{"type", "object"}};
  return {{"oneOf", std::move(alternatives)}};
}

}  // namespace

std::string json_schema(const Registry& registry) {
  Json properties;
  properties["schema"] = {{"const", kConfigSchema}, {"description", "Version of this format."}};
  properties["extends"] = {{"type", "string"}, {"description", "File to build upon, relative to this one."}};
  properties["plugins"] = object({{"search_paths",
                                   {{"type", "array"},
                                    {"items", {{"type", "string"}}},
                                    {"description", "Folders of plugins, relative to this file."}}}});
  for (const auto& section : plugin_sections()) properties[section.name] = plugin_section(section, registry);
  for (const auto& [name, specs] : fixed_sections()) properties[name] = object(properties_of(specs));
  const nlohmann::ordered_json name = {{"type", "string"}};
  const nlohmann::ordered_json names = {{"type", "array"}, {"items", name}};
  const nlohmann::ordered_json lists = {{"type", "array"}, {"items", names}};
  properties["constraints"] = {
      {"type", "object"},
      {"additionalProperties", false},
      {"description", "What the order has to keep to, by names of parts."},
      {"properties", {{"base", names}, {"together", lists}, {"before", lists}, {"target", name}, {"ignore", names}}}};
  properties["layout"]["properties"]["poses"] = {
      {"type", "object"},
      {"description",
       "Where parts lie, by name: [x, y, z, qw, qx, qy, qz], acting on input coordinates, in input units."},
      {"additionalProperties", {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 7}, {"maxItems", 7}}}};
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Dismantle configuration"}};
  schema.update(object(std::move(properties)));
  schema["required"] = {"schema"};
  return schema.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace dismantle
