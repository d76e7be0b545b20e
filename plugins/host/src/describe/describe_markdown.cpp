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
  for (const auto& spec : with_options(specs)) {
    std::string doc = spec.doc;
    for (const auto& choice : spec.choices) doc += fmt::format("<br>`{}`: {}", choice.name, choice.doc);
    out += fmt::format("| `{}` | {} | {} | `{}` | {} | {} |\n", spec.name, type_name(spec), cell(spec.unit),
                       cell(default_text(spec)), cell(limits_text(spec)), cell(doc));
  }
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
  return out + (type.params.empty() ? "None.\n" : table(type.params));
}

std::string describe_sections_markdown() {
  std::string out =
      "# Sections of a configuration\n\nWhat they mean together: [configuration.md](../configuration.md).\n";
  for (const auto& [name, specs] : fixed_sections()) out += fmt::format("\n## {}\n\n{}", name, table(specs));
  for (const PluginSection& section : plugin_sections()) {
    if (section.many == nullptr) continue;
    out += fmt::format("\n## {}\n\nList of `{}`{}. {} Default: `[{}]`.\n", section.name, to_string(section.kind),
                       section.list.empty() ? "" : " at the key `" + section.list + "`", section.doc,
                       joined(section.defaults));
    if (!section.options.empty())
      out += "\nKeys of each item, beside `type` and the parameters of its type:\n\n" + table(section.options);
    if (!section.beside.empty()) out += "\n" + table(section.beside);
  }
  return out;
}

}  // namespace dismantle
