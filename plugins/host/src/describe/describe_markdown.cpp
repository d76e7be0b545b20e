#include <fmt/format.h>

#include "describe/facts.h"
#include "dismantle/host/config.h"
#include "dismantle/host/describe.h"

namespace dismantle {
namespace {

/// Escapes text for a table cell: a bar would begin a new column.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

std::string table(const std::vector<ParamSpec>& specs) {
  std::string out = "| name | type | unit | default | range | meaning |\n|---|---|---|---|---|---|\n";
  for (const auto& spec : with_options(specs, false)) {
    std::string doc = spec.doc;
    for (const auto& choice : spec.choices) doc += fmt::format("<br>`{}`: {}", choice.name, choice.doc);
    out += fmt::format("| `{}` | {} | {} | `{}` | {} | {} |\n", spec.name, type_name(spec), cell(spec.unit),
                       cell(default_text(spec)), cell(limits_text(spec)), cell(doc));
  }
  return out;
}

/// Names, values and ranges of advanced parameters; empty when there are none.
std::string advanced_table(const std::string& title, const std::vector<ParamSpec>& specs) {
  std::string rows;
  for (const auto& spec : with_options(specs, true))
    rows += fmt::format("| `{}` | {} | `{}` | {} |\n", spec.name, type_name(spec), cell(default_text(spec)),
                        cell(limits_text(spec)));
  if (rows.empty()) return "";
  return fmt::format("\n## {}\n\n| name | type | default | range |\n|---|---|---|---|\n{}", title, rows);
}

/// The declared parameters, and where the others are.
std::string parameters_markdown(const std::string& title, const std::vector<ParamSpec>& specs) {
  const std::size_t advanced = with_options(specs, true).size();
  std::string out = !with_options(specs, false).empty() ? table(specs) : advanced == 0 ? "None.\n" : "";
  if (advanced > 0)
    out += fmt::format("{}[{} advanced parameters](advanced.md#{}), for studies.\n", out.empty() ? "" : "\n", advanced,
                       title);
  return out;
}

std::string markdown_fact(const std::string& name, const std::string& value) {
  return value.empty() ? "" : fmt::format("- {}: {}\n", name, value);
}

}  // namespace

std::string describe_markdown(const RegisteredType& registered, const Registry& registry) {
  const PluginType& type = registered.type;
  const PluginFile& file = *registered.file;
  std::string out = fmt::format("# {}\n\n{}\n\n", type.id, type.summary);
  out += markdown_fact("kind", fmt::format("`{}`", to_string(type.kind)));
  if (!registered.preset_of.empty())
    out += markdown_fact("preset of", fmt::format("[{0}]({1}_{0}.md), `configs/presets/{1}/{2}.yaml`",
                                                  registered.preset_of, to_string(type.kind), type.id));
  out += markdown_fact("source", type.traits.source);
  out += markdown_fact("needs", joined(capability_words(type.traits.needs)));
  out += markdown_fact("provides", joined(capability_words(type.traits.provides)));
  out += markdown_fact(
      "plugin", fmt::format("{} {} ({}), {}", file.id, file.version, file.licence, file.path.filename().string()));
  if (!registered.preset_of.empty())
    out += fmt::format("\n## Stands for\n\n```yaml\n{}```\n", expansion(registered, registry));
  out += "\n## Parameters\n\n";
  if (registered.preset_of.empty()) return out + parameters_markdown(type.id, type.params);
  return out + fmt::format("Those of [{0}]({1}_{0}.md). The values above are their defaults here.\n", registered.preset_of,
                           to_string(type.kind));
}

std::string describe_sections_markdown() {
  std::string out =
      "# Sections of a configuration\n\nWhat they mean together: [configuration.md](../configuration.md).\n";
  for (const auto& [name, specs] : fixed_sections())
    out += fmt::format("\n## {}\n\n{}", name, parameters_markdown(name, specs));
  for (const PluginSection& section : plugin_sections()) {
    if (section.many == nullptr) continue;
    out += fmt::format("\n## {}\n\nList of `{}`{}. {} Default: `[{}]`.\n", section.name, to_string(section.kind),
                       section.list.empty() ? "" : " at the key `" + section.list + "`", section.doc,
                       joined(section.defaults));
    if (!section.options.empty())
      out += "\nKeys of each item, beside `type` and the parameters of its type:\n\n" + table(section.options);
    if (!section.beside.empty()) out += "\n" + parameters_markdown(section.name, section.beside);
  }
  return out;
}

std::string describe_advanced_markdown(const Registry& registry) {
  std::string out =
      "# Advanced parameters\n\nOnly studies of the algorithms change them. They are keys of the map `advanced` of the "
      "plugin or section: `path_planner: {type: tunnel_forest, advanced: {tournament: 3}}`, or `--set "
      "path_planner.advanced.tournament=3`. What each means is the comment at the member of that name in the source. "
      "How much plans depend on them: [parameters.md](../parameters.md).\n";
  for (const PluginKind kind : kPluginKinds)
    for (const RegisteredType* type : registry.types(kind))
      if (type->preset_of.empty()) out += advanced_table(type->type.id, type->type.params);
  for (const auto& [name, specs] : fixed_sections()) out += advanced_table(name, specs);
  for (const PluginSection& section : plugin_sections())
    if (section.many != nullptr) out += advanced_table(section.name, list_section(section, registry));
  return out;
}

}  // namespace dismantle
