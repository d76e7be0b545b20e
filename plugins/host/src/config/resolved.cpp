#include <fmt/format.h>

#include <algorithm>

#include "dismantle/host/config.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

constexpr int kCommentColumn = 44;

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

/// Text that YAML reads as itself without quotes: a word that means nothing else.
std::string plain_or_quoted(const std::string& text) {
  const bool word =
      !text.empty() && text[0] >= 'a' && text[0] <= 'z' && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
      });
  return word && text != "true" && text != "false" && text != "null" ? text : quoted(text);
}

/// Comments end at the line: a file name may hold a line break.
std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return text;
}

class Writer {
 public:
  explicit Writer(const RunConfig& config) : config_(config) {}

  void line(const std::string& text) { out_ += text + "\n"; }

  void value(const std::string& section, const std::string& key, const std::string& text) {
    const auto origin = config_.origins.find(section + "." + key);
    std::string row = fmt::format("  {}: {}", key, text);
    if (origin != config_.origins.end())
      row = fmt::format("{:<{}}  # {}", row, kCommentColumn, one_line(origin->second));
    line(row);
  }

  void pose(const std::string& part, const Pose& p) {
    std::string numbers;
    for (const double x : {p.t.x(), p.t.y(), p.t.z(), p.q.w(), p.q.x(), p.q.y(), p.q.z()})
      numbers += (numbers.empty() ? "" : ", ") + to_text(ParamValue{x});
    std::string row = fmt::format("    {}: [{}]", quoted(part), numbers);
    const auto origin = config_.origins.find("layout.poses." + part);
    if (origin != config_.origins.end())
      row = fmt::format("{:<{}}  # {}", row, kCommentColumn, one_line(origin->second));
    line(row);
  }

  std::string list(const std::vector<std::string>& names) {
    std::string out;
    for (const auto& name : names) out += (out.empty() ? "" : ", ") + quoted(name);
    return "[" + out + "]";
  }

  void constraints(const NamedConstraints& c) {
    if (c.base.empty() && c.together.empty() && c.before.empty() && c.target.empty() && c.ignore.empty()) return;
    line("constraints:");
    if (!c.base.empty()) line("  base: " + list(c.base));
    for (const auto& [key, lists] : {std::pair("together", &c.together), std::pair("before", &c.before)}) {
      if (!lists->empty()) line(fmt::format("  {}:", key));
      for (const auto& names : *lists) line("    - " + list(names));
    }
    if (!c.target.empty()) line("  target: " + quoted(c.target));
    if (!c.ignore.empty()) line("  ignore: " + list(c.ignore));
  }

  void values(const std::string& section, const std::vector<ParamSpec>& specs, const ParamSet& params) {
    for (const auto& spec : specs) {
      const auto it = params.find(spec.name);
      if (it == params.end()) continue;
      const auto* text = std::get_if<std::string>(&it->second);
      value(section, spec.name,
            text != nullptr ? (spec.type == ParamType::choice ? plain_or_quoted(*text) : quoted(*text))
                            : to_text(it->second));
    }
  }

  void plugin(const PluginSection& section, const PluginChoice& choice, const Registry& registry) {
    const RegisteredType& type = registry.find(section.kind, choice.type);
    const PluginFile& file = *type.file;
    line(fmt::format("{}:", section.name));
    line(one_line(fmt::format("  # plugin {} {}, {}, sha256 {}", file.id, file.version, file.path.filename().string(),
                              sha256_of_file(file.path))));
    value(section.name, "type", plain_or_quoted(choice.type));
    values(section.name, type.type.params, choice.params);
  }

  std::string take() { return std::move(out_); }

 private:
  const RunConfig& config_;
  std::string out_;
};

std::string relative_to(const fs::path& path, const fs::path& folder) {
  std::error_code error;
  const fs::path absolute = fs::weakly_canonical(path, error);
  const fs::path home = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
  const fs::path relative = absolute.lexically_relative(home);
  return relative.empty() ? absolute.string() : relative.string();
}

}  // namespace

std::string resolved_yaml(const RunConfig& config, const Registry& registry, const fs::path& folder) {
  Writer writer(config);
  writer.line(
      fmt::format("# Written by dismantle {}: every value of this run, and where it came from.", DISMANTLE_VERSION));
  writer.line("# The same input with this file gives the same plan.");
  writer.line(fmt::format("schema: {}", kConfigSchema));
  if (!config.plugin_search_paths.empty()) {
    writer.line("plugins:");
    writer.line("  search_paths:");
    for (const auto& path : config.plugin_search_paths) writer.line("    - " + quoted(relative_to(path, folder)));
  }
  const auto fixed = [&](const std::string& name) {
    for (const auto& [section, specs] : fixed_sections()) {
      if (section != name) continue;
      writer.line(name + ":");
      writer.values(name, specs, config.sections.at(name));
    }
  };
  fixed("assembly");
  const PluginChoice* choices[] = {&config.simulator, &config.path_planner, &config.sequence_planner,
                                   &config.transfer_planner};
  for (std::size_t i = 0; i < plugin_sections().size(); ++i) writer.plugin(plugin_sections()[i], *choices[i], registry);
  fixed("layout");
  if (!config.layout.poses.empty()) {
    writer.line("  poses:");
    for (const auto& [part, pose] : config.layout.poses) writer.pose(part, pose);
  }
  writer.constraints(config.constraints);
  fixed("run");
  fixed("verify");
  return writer.take();
}

}  // namespace dismantle
