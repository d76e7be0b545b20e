#include <fmt/format.h>

#include <algorithm>

#include "describe/facts.h"
#include "dismantle/host/describe.h"

namespace dismantle {
namespace {

/// Breaks `text` at blanks into lines shorter than `width`; all lines begin with `indent` blanks.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t width) {
  std::string out, line;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (!line.empty() && indent + line.size() + 1 + word.size() > width) {
      out += std::string(indent, ' ') + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
    begin = end + 1;
  }
  if (!line.empty()) out += std::string(indent, ' ') + line + "\n";
  return out;
}

std::string text_fact(const std::string& name, const std::string& value) {
  return value.empty() ? "" : fmt::format("  {:<10}{}\n", name, value);
}

std::string parameter_text(const ParamSpec& spec) {
  std::string head = fmt::format("  {} = {}", spec.name, default_text(spec));
  if (!spec.unit.empty() && spec.unit != "1") head += " " + spec.unit;
  head += fmt::format("   ({}", type_name(spec));
  const std::string limits = limits_text(spec);
  if (!limits.empty()) head += ", " + limits;
  std::string out = head + ")\n" + wrapped(spec.doc, 6, 100);
  for (const auto& choice : spec.choices) out += wrapped(fmt::format("{}: {}", choice.name, choice.doc), 8, 100);
  return out;
}

}  // namespace

std::string describe_text(const RegisteredType& registered, const Registry& registry) {
  const PluginType& type = registered.type;
  const PluginFile& file = *registered.file;
  const bool preset = !registered.preset_of.empty();
  std::string out = fmt::format("{} ({}{})\n", type.id, to_string(type.kind), preset ? " preset" : "") +
                    wrapped(type.summary, 2, 100) + "\n";
  if (preset) out += text_fact("preset of", registered.preset_of) + text_fact("in", registered.preset_file.string());
  out += text_fact("source", type.traits.source);
  out += text_fact("needs", joined(capability_words(type.traits.needs)));
  out += text_fact("provides", joined(capability_words(type.traits.provides)));
  out += text_fact("plugin",
                   fmt::format("{} {} ({}){}", file.id, file.version, file.licence, file.built_in ? ", built in" : ""));
  out += text_fact("url", file.url);
  out += text_fact("file", file.path.string());
  out += "\n";
  if (preset) {
    out += "Stands for:\n";
    const std::string yaml = expansion(registered, registry);
    for (std::size_t begin = 0, end; begin < yaml.size(); begin = end + 1) {
      end = yaml.find('\n', begin);
      out += "  " + yaml.substr(begin, end - begin) + "\n";
    }
    out += "\n";
  }
  const auto declared = with_options(type.params, false), advanced = with_options(type.params, true);
  out += declared.empty() ? "No parameters.\n" : "Parameters:\n";
  for (const auto& spec : declared) out += parameter_text(spec);
  if (!advanced.empty()) out += "\nAdvanced parameters, for studies, in the map 'advanced':\n";
  for (const auto& spec : advanced) out += parameter_text(spec);
  return out;
}

}  // namespace dismantle
