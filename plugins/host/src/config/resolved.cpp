#include <fmt/format.h>

#include <map>

#include "config/components.h"
#include "config/yaml_writer.h"
#include "dismantle/host/config.h"
#include "dismantle/preparation/sha256.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

class Writer {
 public:
  Writer(const RunConfig& config, const Registry& registry)
      : yaml_(registry, config.origins, [this](const RegisteredType& type) { return origin(type); }) {}
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void line(const std::string& text) { yaml_.line(text); }

  void pose(const std::string& part, const Pose& p) {
    std::string numbers;
    for (const double x : {p.t.x(), p.t.y(), p.t.z(), p.q.w(), p.q.x(), p.q.y(), p.q.z()})
      numbers += (numbers.empty() ? "" : ", ") + to_text(ParamValue{x});
    yaml_.row("    " + quoted(part) + ": ", "[" + numbers + "]", "layout.poses." + part);
  }

  std::string list(const std::vector<std::string>& names) {
    std::string out;
    for (const auto& name : names) out += (out.empty() ? "" : ", ") + quoted(name);
    return "[" + out + "]";
  }

  void constraints(const NamedConstraints& c) {
    if (c.base.empty() && c.together.empty() && c.before.empty() && c.target.empty() && c.ignore.empty() &&
        c.flexible.empty() && c.overlap.empty() && c.accept.empty())
      return;
    line("constraints:");
    if (!c.base.empty()) line("  base: " + list(c.base));
    for (const auto& [key, lists] : {std::pair("together", &c.together), std::pair("before", &c.before)}) {
      if (!lists->empty()) line(fmt::format("  {}:", key));
      for (const auto& names : *lists) line("    - " + list(names));
    }
    if (!c.target.empty()) line("  target: " + quoted(c.target));
    if (!c.ignore.empty()) line("  ignore: " + list(c.ignore));
    if (!c.flexible.empty()) line("  flexible: " + list(c.flexible));
    if (!c.overlap.empty()) line("  overlap:");
    for (const NamedOverlap& o : c.overlap)
      line(fmt::format("    - {{parts: {}, depth: {}}}", list({o.a, o.b}), to_text(ParamValue{o.depth})));
    if (!c.accept.empty()) line("  accept:");
    for (const NamedAcceptance& a : c.accept)
      line(fmt::format("    - {{part: {}, against: {}, as: {}, depth: {}}}", quoted(a.part), quoted(a.against),
                       quoted(a.as), to_text(ParamValue{a.depth})));
  }

  void parts(const std::vector<StatedPart>& stated) {
    if (!stated.empty()) line("parts:");
    for (const StatedPart& p : stated) {
      std::string out;
      const auto add = [&](const char* key, const std::string& value) {
        out += fmt::format("{}{}: {}", out.empty() ? "" : ", ", key, value);
      };
      if (!p.kind.empty()) add("kind", quoted(p.kind));
      if (!p.size.empty()) add("size", quoted(p.size));
      if (p.length) add("length", to_text(ParamValue{*p.length}));
      if (p.torque) add("torque", to_text(ParamValue{*p.torque}));
      if (!p.glue.empty()) add("glue", quoted(p.glue));
      line(fmt::format("  {}: {{{}}}", quoted(p.pattern), out));
    }
  }

  void section(const std::string& name, const std::vector<ParamSpec>& specs, const ParamSet& params) {
    yaml_.section(name, specs, params);
  }

  void plugins(const PluginSection& section, const RunConfig& config, const Registry& registry) {
    const std::vector<ParamSpec> specs =
        section.one != nullptr ? std::vector<ParamSpec>() : list_section(section, registry);
    if (section.one == nullptr && section.list.empty()) {
      yaml_.values("", 0, specs, {{section.name, config.*section.many}});
      return;
    }
    line(fmt::format("{}:", section.name));
    if (section.one != nullptr) {
      yaml_.choice(section.name, 2, section.kind, {}, config.*section.one);
    } else {
      ParamSet values = config.sections.at(section.name);
      values[section.list] = config.*section.many;
      yaml_.values(section.name, 2, specs, values);
    }
  }

  /// Writes only non-default values, so that a file for mesh input does not need the CAD importer.
  void importers(const ImportParameters& params, const Registry& registry) {
    if (params.empty()) return;
    line("importers:");
    for (const auto& [id, values] : params) {
      line(fmt::format("  {}:", plain_or_quoted(id)));
      yaml_.values("importers." + id, 4, registry.find(PluginKind::importer, id).type.params, values);
    }
  }

  const std::string& text() const { return yaml_.text(); }

 private:
  /// Describes the plugin file of a type.
  std::string origin(const RegisteredType& type) {
    const PluginFile& file = *type.file;
    std::string& hash = hashes_[file.path];
    if (hash.empty()) hash = sha256_of_file(file.path);
    const std::string plugin =
        fmt::format("plugin {} {}, {}, sha256 {}", file.id, file.version, file.path.filename().string(), hash);
    if (type.preset_of.empty()) return plugin;
    return fmt::format("preset of {}, sha256 {}; {}", type.preset_of, sha256_of_file(type.preset_file), plugin);
  }

  std::map<fs::path, std::string> hashes_;
  YamlWriter yaml_;
};

std::string relative_to(const fs::path& path, const fs::path& folder) {
  std::error_code error;
  const fs::path absolute = fs::weakly_canonical(path, error);
  const fs::path home = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
  const fs::path relative = absolute.lexically_relative(home);
  return relative.empty() ? absolute.string() : relative.string();
}

}  // namespace

ImportParameters import_params_of(const RunConfig& config, const Registry& registry) {
  ImportParameters out;
  for (const auto& [id, values] : config.importers)
    for (const auto& spec : registry.find(PluginKind::importer, id).type.params)
      if (const auto& value = values.at(spec.name); value != spec.fallback) out[id][spec.name] = value;
  return out;
}

std::string resolved_yaml(const RunConfig& config, const Registry& registry, const fs::path& folder) {
  Writer writer(config, registry);
  writer.line(
      fmt::format("# Written by dismantle {}: the values of this run, and where they came from.", DISMANTLE_VERSION));
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
      writer.section(name, specs, config.sections.at(name));
    }
  };
  writer.importers(import_params_of(config, registry), registry);
  fixed("assembly");
  for (const PluginSection& section : plugin_sections()) writer.plugins(section, config, registry);
  fixed("layout");
  if (!config.layout.poses.empty()) {
    writer.line("  poses:");
    for (const auto& [part, pose] : config.layout.poses) writer.pose(part, pose);
  }
  writer.constraints(config.constraints);
  for (const std::string& line : component_lines(config.components)) writer.line(line);
  writer.parts(config.parts);
  fixed("run");
  fixed("verify");
  return writer.text();
}

}  // namespace dismantle
