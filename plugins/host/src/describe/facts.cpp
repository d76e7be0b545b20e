#include "describe/facts.h"

#include <fmt/format.h>

#include "config/yaml_writer.h"

namespace dismantle {

std::string type_name(const ParamSpec& spec) {
  switch (spec.type) {
    case ParamType::boolean:
      return "boolean";
    case ParamType::integer:
      return "integer";
    case ParamType::number:
      return "number";
    case ParamType::text:
      return "text";
    case ParamType::choice:
      return "choice";
    case ParamType::plugin:
      return std::string(to_string(spec.plugin_kind));
    case ParamType::plugins:
      return fmt::format("list of {}", to_string(spec.plugin_kind));
  }
  return "value";
}

std::string default_text(const ParamSpec& spec) {
  if (spec.required) return "none: required";
  if (const auto* one = std::get_if<PluginChoice>(&spec.fallback)) return one->type;
  if (const auto* many = std::get_if<std::vector<PluginChoice>>(&spec.fallback)) {
    std::vector<std::string> types;
    for (const auto& choice : *many) types.push_back(choice.type);
    return "[" + joined(types) + "]";
  }
  const std::string text = to_text(spec.fallback);
  return text.empty() ? "\"\"" : text;
}

std::string limits_text(const ParamSpec& spec) {
  if (spec.type == ParamType::boolean) return "true | false";
  if (spec.type != ParamType::choice) return spec.range_text();
  std::vector<std::string> names;
  for (const auto& choice : spec.choices) names.push_back(choice.name);
  return joined(names, " | ");
}

std::vector<std::string> capability_words(const Capabilities& c) {
  std::vector<std::string> words;
  if (c.dynamics) words.emplace_back("dynamics");
  if (c.contacts) words.emplace_back("contacts");
  if (c.distance) words.emplace_back("distance");
  if (c.max_moving == static_cast<unsigned>(-1))
    words.emplace_back("any number of parts moving simultaneously");
  else if (c.max_moving > 1)
    words.push_back(fmt::format("{} parts moving simultaneously", c.max_moving));
  return words;
}

std::vector<ParamSpec> with_options(const std::vector<ParamSpec>& specs, bool advanced) {
  std::vector<ParamSpec> all;
  for (const auto& spec : specs) {
    if (spec.advanced == advanced) all.push_back(spec);
    for (ParamSpec option : with_options(spec.options, advanced)) {
      option.name = spec.name + "[]." + option.name;
      all.push_back(std::move(option));
    }
  }
  return all;
}

std::string expansion(const RegisteredType& preset, const Registry& registry) {
  PluginChoice choice{preset.preset_of, {}, {}};
  for (const auto& spec : preset.type.params) choice.parameters.emplace(spec.name, spec.fallback);
  const std::map<std::string, std::string> no_origins;
  YamlWriter writer(registry, no_origins, nullptr);
  writer.line(fmt::format("{}:", to_string(preset.type.kind)));
  writer.choice("", 2, preset.type.kind, {}, choice);
  return writer.text();
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

}  // namespace dismantle
