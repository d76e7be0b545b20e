#include "config/yaml_writer.h"

#include <fmt/format.h>

#include <algorithm>

namespace dismantle {
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += fmt::format("\\{}", c);
    else if (c == '\n')
      out += "\\n";
    else if (c == '\t')
      out += "\\t";
    else if (byte < 0x20 || byte == 0x7f)
      out += fmt::format("\\x{:02x}", byte);
    else
      out += c;
  }
  return out + '"';
}

/// A word without a special meaning in YAML needs no quotes.
std::string plain_or_quoted(const std::string& text) {
  const bool word =
      !text.empty() && text[0] >= 'a' && text[0] <= 'z' && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
      });
  return word && text != "true" && text != "false" && text != "null" ? text : quoted(text);
}

/// A file name may contain a line break.
std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return text;
}

void YamlWriter::row(const std::string& lead, const std::string& text, const std::string& path) {
  const auto origin = origins_.find(path);
  std::string row = lead + text;
  if (origin != origins_.end()) row = fmt::format("{:<44}  # {}", row, one_line(origin->second));
  line(row);
}

void YamlWriter::values(const std::string& path, std::size_t indent, const std::vector<ParamSpec>& specs,
                        const ParamSet& values) {
  for (const auto& spec : specs)
    if (const auto it = values.find(spec.name); !spec.advanced && it != values.end())
      value(path, indent, spec, it->second);
  bool first = true;
  for (const auto& spec : specs) {
    const auto it = values.find(spec.name);
    if (!spec.advanced || it == values.end() || it->second == spec.fallback) continue;
    if (first) line(std::string(indent, ' ') + "advanced:");
    first = false;
    value(path + ".advanced", indent + 2, spec, it->second);
  }
}

void YamlWriter::section(const std::string& name, const std::vector<ParamSpec>& specs, const ParamSet& all) {
  const std::size_t before = out_.size();
  line(name + ":");
  const std::size_t head = out_.size();
  values(name, 2, specs, all);
  if (out_.size() == head) out_.resize(before);  // a key without a value is an error
}

void YamlWriter::value(const std::string& path, std::size_t indent, const ParamSpec& spec, const ParamValue& value) {
  const std::string blanks(indent, ' '), place = path.empty() ? spec.name : path + "." + spec.name;
  const std::string lead = blanks + spec.name + ": ";
  if (const auto* text = std::get_if<std::string>(&value)) {
    row(lead, spec.type == ParamType::choice ? plain_or_quoted(*text) : quoted(*text), place);
  } else if (const auto* one = std::get_if<PluginChoice>(&value)) {
    line(blanks + spec.name + ":");
    choice(place, indent + 2, spec.plugin_kind, spec.options, *one, std::get_if<PluginChoice>(&spec.fallback));
  } else if (const auto* many = std::get_if<std::vector<PluginChoice>>(&value)) {
    if (many->empty())
      row(lead, "[]", place);
    else
      line(blanks + spec.name + ":");
    for (std::size_t k = 0; k < many->size(); ++k) {
      const std::size_t begin = out_.size();
      choice(fmt::format("{}.{}", place, k), indent + 4, spec.plugin_kind, spec.options, (*many)[k]);
      const std::size_t type = out_.find(blanks + "    type: ", begin);
      out_[type + indent + 2] = '-';  // the first key of the item
    }
  } else {
    row(lead, to_text(value), place);
  }
}

void YamlWriter::choice(const std::string& path, std::size_t indent, PluginKind kind,
                        const std::vector<ParamSpec>& options, const PluginChoice& choice, const PluginChoice* below) {
  const RegisteredType& type = registry_.find(kind, choice.type);
  const std::string blanks(indent, ' ');
  if (plugin_comment_) line(blanks + "# " + one_line(plugin_comment_(type)));
  row(blanks + "type: ", plain_or_quoted(choice.type), path + ".type");
  std::vector<ParamSpec> specs = options;  // they stand in one map
  specs.insert(specs.end(), type.type.params.begin(), type.type.params.end());
  ParamSet all = choice.options;
  all.insert(choice.parameters.begin(), choice.parameters.end());
  if (below != nullptr && below->type == choice.type)
    for (ParamSpec& spec : specs)
      if (const auto it = below->parameters.find(spec.name); it != below->parameters.end()) spec.fallback = it->second;
  values(path, indent, specs, all);
}

}  // namespace dismantle
