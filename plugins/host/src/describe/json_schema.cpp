#include <fmt/format.h>

#include "describe/json_value.h"
#include "dismantle/fasteners/kinds.h"
#include "dismantle/host/config.h"
#include "dismantle/host/describe.h"

namespace dismantle {
namespace {

/// Definitions of list items and plugin parameters by name; they refer to each other.
class Definitions {
 public:
  explicit Definitions(const Registry& registry) : registry_(registry) {}

  /// Reference to "any plugin of this kind, with these options beside its own parameters".
  Json choice_of(PluginKind kind, const std::vector<ParamSpec>& options, const std::string& place);
  const Registry& registry() const { return registry_; }
  Json take() { return std::move(all_); }

 private:
  const Registry& registry_;
  Json all_ = Json::object();
};

Json parameter_schema(const ParamSpec& spec, const std::string& place, Definitions& definitions) {
  Json json;
  switch (spec.type) {
    case ParamType::plugin:
      json["anyOf"] = {Json{{"type", "string"}}, definitions.choice_of(spec.plugin_kind, {}, place)};
      break;
    case ParamType::plugins: {
      const Json item = {
          {"anyOf", {Json{{"type", "string"}}, definitions.choice_of(spec.plugin_kind, spec.options, place)}}};
      json["anyOf"] = {Json{{"type", "array"}, {"items", item}, {"minItems", spec.may_be_empty ? 0 : 1}},
                       // changes single items of the list below, named by index or type
                       Json{{"type", "object"}, {"additionalProperties", {{"type", "object"}}}}};
      break;
    }
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
  if (!spec.required) json["default"] = json_value(spec, spec.fallback, definitions.registry());
  if (!spec.doc.empty())
    json["description"] = spec.unit.empty() || spec.unit == "1" ? spec.doc : fmt::format("{} [{}]", spec.doc, spec.unit);
  return json;
}

Json object(Json properties) {
  return {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
}

Json properties_of(const std::vector<ParamSpec>& specs, const std::string& place, Definitions& definitions) {
  Json properties = Json::object(), advanced = Json::object();
  for (const auto& spec : specs)
    (spec.advanced ? advanced : properties)[spec.name] = parameter_schema(spec, place + "." + spec.name, definitions);
  if (!advanced.empty()) properties["advanced"] = object(std::move(advanced));
  return properties;
}

/// One alternative per type; the type `optional_id` may omit its id.
Json alternatives(const Registry& registry, PluginKind kind, const std::vector<ParamSpec>& options,
                  const std::string& optional_id, Definitions& definitions) {
  Json all = Json::array();
  for (const auto* registered : registry.types(kind)) {
    const PluginType& type = registered->type;
    const std::string& base = registered->preset_of.empty() ? type.id : registered->preset_of;
    Json properties = {{"type", {{"const", type.id}, {"description", type.summary}}}};
    properties.update(properties_of(options, "option", definitions));
    properties.update(properties_of(type.params, base, definitions), true);
    Json alternative = object(std::move(properties));
    Json required = Json::array();
    if (type.id != optional_id) required.push_back("type");
    for (const auto& spec : type.params)
      if (spec.required) required.push_back(spec.name);
    if (!required.empty()) alternative["required"] = std::move(required);
    all.push_back(std::move(alternative));
  }
  return all;
}

Json Definitions::choice_of(PluginKind kind, const std::vector<ParamSpec>& options, const std::string& place) {
  if (!all_.contains(place)) {
    all_[place] = Json();  // placeholder: a type may contain plugins of its own kind
    all_[place] = {{"oneOf", alternatives(registry_, kind, options, "", *this)}};
  }
  return {{"$ref", "#/$defs/" + place}};
}

Json plugin_section(const PluginSection& section, const Registry& registry, Definitions& definitions) {
  if (section.many != nullptr) {
    const std::vector<ParamSpec> specs = list_section(section, registry);
    return section.list.empty() ? parameter_schema(specs.front(), section.name, definitions)
                                : object(properties_of(specs, section.name, definitions));
  }
  Json all = alternatives(registry, section.kind, {}, section.defaults.front(), definitions);
  if (all.empty()) return {{"type", "object"}};
  return {{"oneOf", std::move(all)}};
}

}  // namespace

std::string json_schema(const Registry& registry) {
  Definitions definitions(registry);
  Json properties;
  properties["schema"] = {{"const", kConfigSchema}, {"description", "Version of this format."}};
  properties["extends"] = {{"type", "string"}, {"description", "File to build upon, relative to this one."}};
  properties["plugins"] = object({{"search_paths",
                                   {{"type", "array"},
                                    {"items", {{"type", "string"}}},
                                    {"description", "Folders of plugins, relative to this file."}}}});
  for (const auto& section : plugin_sections())
    properties[section.name] = plugin_section(section, registry, definitions);
  for (const auto& [name, specs] : fixed_sections()) properties[name] = object(properties_of(specs, name, definitions));
  Json importers = Json::object();
  for (const auto* type : registry.types(PluginKind::importer))
    if (!type->type.params.empty())
      importers[type->type.id] = object(properties_of(type->type.params, "importers." + type->type.id, definitions));
  properties["importers"] = object(std::move(importers));
  properties["importers"]["description"] = "Parameters of importers, by id.";
  const nlohmann::ordered_json name = {{"type", "string"}};
  const nlohmann::ordered_json names = {{"type", "array"}, {"items", name}};
  const nlohmann::ordered_json lists = {{"type", "array"}, {"items", names}};
  const nlohmann::ordered_json overlap = {
      {"type", "object"},
      {"additionalProperties", false},
      {"required", {"parts", "depth"}},
      {"properties",
       {{"parts", {{"type", "array"}, {"items", name}, {"minItems", 2}, {"maxItems", 2}}},
        {"depth", {{"type", "number"}, {"minimum", 0}}}}}};
  const nlohmann::ordered_json accept = {
      {"type", "object"},
      {"additionalProperties", false},
      {"required", {"part", "against", "as", "depth"}},
      {"properties",
       {{"part", name}, {"against", name}, {"as", name}, {"depth", {{"type", "number"}, {"exclusiveMinimum", 0}}}}}};
  properties["constraints"] = {{"type", "object"},
                               {"additionalProperties", false},
                               {"description", "What the order has to keep to, by names of parts."},
                               {"properties",
                                {{"base", names},
                                 {"together", lists},
                                 {"before", lists},
                                 {"target", name},
                                 {"ignore", names},
                                 {"flexible", names},
                                 {"overlap", {{"type", "array"}, {"items", overlap}}},
                                 {"accept", {{"type", "array"}, {"items", accept}}}}}};
  properties["components"] = {
      {"type", "object"},
      {"additionalProperties", false},
      {"description", "Which products of the file are put in as one, by names; '*' and '?' match."},
      {"properties",
       {{"level", {{"anyOf", {{{"enum", {"component", "solid"}}}, {{"type", "integer"}, {"minimum", 1}}}}}},
        {"together", names},
        {"apart", names}}}};
  const nlohmann::ordered_json length = {{"type", "number"}, {"exclusiveMinimum", 0}};
  Json kinds = Json::array();
  for (const std::string_view kind : fasteners::kKindNames) kinds.push_back(kind);
  properties["parts"] = {
      {"type", "object"},
      {"description", "What parts are, by patterns of their names: kind, size, length (mm), torque (N m), glue."},
      {"additionalProperties",
       {{"type", "object"},
        {"additionalProperties", false},
        {"properties",
         {{"kind", {{"enum", kinds}}}, {"size", name}, {"length", length}, {"torque", length}, {"glue", name}}}}}};
  properties["layout"]["properties"]["poses"] = {
      {"type", "object"},
      {"description",
       "Where parts lie, by name: [x, y, z, qw, qx, qy, qz], acting on input coordinates, in input units."},
      {"additionalProperties", {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 7}, {"maxItems", 7}}}};
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Dismantle configuration"}};
  schema.update(object(std::move(properties)));
  schema["required"] = {"schema"};
  if (Json all = definitions.take(); !all.empty()) schema["$defs"] = std::move(all);
  return schema.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace dismantle
