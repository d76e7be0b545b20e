#include "dismantle/host/config.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "config/binder.h"
#include "config/components.h"
#include "config/constraints.h"
#include "config/layers.h"
#include "config/sections.h"
#include "config/stated_parts.h"
#include "dismantle/geometry/direction.h"
#include "dismantle/host/config_bind.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

/// One pass over the merged tree. Each step reports all errors that it finds.
class Loader {
 public:
  Loader(const ConfigNode& root, Registry& registry, std::vector<Diagnostic>& problems)
      : root_(root), registry_(registry), problems_(problems), types_(types_of(registry)) {}

  RunConfig load() {
    check_top_level();
    read_plugins();
    for (const auto& section : plugin_sections())
      if (section.one != nullptr) choose(section);
    collect_homes();
    for (const auto& section : plugin_sections())
      if (section.one != nullptr) bind_plugin(section);
    bind_importers();
    for (const auto& [name, specs] : fixed_sections()) {
      const ConfigNode* section = node(name);
      ConfigNode plain;
      if (name == "layout" && section != nullptr && section->is_map()) {
        plain = without_poses(*section);
        section = &plain;
      }
      config_.sections[name] = binder().section(specs, section, {name, "", ""});
    }
    for (const auto& section : plugin_sections())
      if (section.many != nullptr) bind_list(section);
    if (const ConfigNode* section = node("constraints"); section != nullptr)
      config_.constraints = read_constraints(*section, config_.constraint_names, problems_);
    if (const ConfigNode* section = node("components"); section != nullptr)
      config_.components = read_components(*section, config_.component_names, problems_);
    if (const ConfigNode* section = node("parts"); section != nullptr)
      config_.parts = read_stated_parts(*section, problems_);
    check_capabilities();
    return std::move(config_);
  }

 private:
  struct Chosen {
    const RegisteredType* type = nullptr;
    ConfigMark mark;
    bool named = false;
  };

  const ConfigNode* node(const std::string& key) const {
    const auto* member = root_.find(key);
    return member == nullptr ? nullptr : &member->value;
  }

  void bind_list(const PluginSection& section) {
    std::vector<PluginChoice>& list = config_.*section.many;
    std::optional<ParamValue> bound;
    if (section.list.empty()) {
      bound = binder().list(plugin_list(section, registry_), node(section.name), section.name);
    } else {
      ParamSet& values = config_.sections[section.name];
      values = binder().section(list_section(section, registry_), node(section.name), {section.name, "", ""});
      if (auto found = values.extract(section.list)) bound = std::move(found.mapped());
    }
    if (!bound) return;
    list = std::get<std::vector<PluginChoice>>(std::move(*bound));
    std::set<std::string> seen;
    for (std::size_t k = 0; k < list.size(); ++k)
      if (!seen.insert(list[k].type).second)
        problems_.push_back({config_.origins[fmt::format("{}.{}.type", section.key(), k)], 0, 0,
                             fmt::format("{} lists '{}' twice", section.key(), list[k].type)});
  }

  void check_top_level() {
    std::vector<std::string> known = {"schema",      "extends",    "plugins", "importers",
                                      "constraints", "components", "parts"};
    for (const auto& section : plugin_sections()) known.push_back(section.name);
    for (const auto& section : fixed_sections()) known.push_back(section.first);
    for (const auto& member : root_.members)
      if (std::find(known.begin(), known.end(), member.key) == known.end()) unknown_top_.push_back({&member, known});
  }

  void read_plugins() {
    const ConfigNode* plugins = node("plugins");
    if (plugins != nullptr && !plugins->is_map()) {
      problems_.push_back(
          plugins->mark.error(fmt::format("plugins must be a map of keys, not {}", plugins->kind_name())));
    } else if (plugins != nullptr) {
      for (const auto& member : plugins->members) {
        if (member.key == "search_paths")
          read_search_paths(member.value);
        else
          unknown_plugins_.push_back(&member);
      }
    }
    for (const auto& path : config_.plugin_search_paths) registry_.add_search_path(path);
    registry_.scan();
  }

  void read_search_paths(const ConfigNode& list) {
    if (list.kind != ConfigNode::Kind::sequence) {
      problems_.push_back(
          list.mark.error(fmt::format("plugins.search_paths must be a list of folders, not {}", list.kind_name())));
      return;
    }
    for (const auto& item : list.items) {
      if (!item.is_scalar() || item.scalar.empty()) {
        problems_.push_back(
            item.mark.error(fmt::format("plugins.search_paths must hold names of folders, not {}", item.kind_name())));
        continue;
      }
      // A path is relative to the file that states it, or to the working directory if the command line does.
      const std::string file = item.mark.file();
      const fs::path base = file.starts_with('<') ? fs::path() : fs::path(file).parent_path();
      const fs::path path = (base / item.scalar).lexically_normal();
      std::error_code error;
      if (!fs::exists(path, error))
        problems_.push_back(item.mark.error(fmt::format("plugin folder '{}' does not exist", path.string())));
      else
        config_.plugin_search_paths.push_back(path);
      config_.origins[fmt::format("plugins.search_paths.{}", config_.plugin_search_paths.size())] = item.mark.text();
    }
  }

  void choose(const PluginSection& section) {
    Chosen& chosen = chosen_[section.name];
    const ConfigNode* map = node(section.name);
    if (map != nullptr) chosen.mark = map->mark;
    const ConfigMember* type = map != nullptr && map->is_map() ? map->find("type") : nullptr;
    std::string id = section.defaults.front();
    std::string origin = "default";
    if (type != nullptr) {
      chosen.mark = type->value.mark;
      if (!type->value.is_scalar() || type->value.scalar.empty()) {
        problems_.push_back(type->value.mark.error(fmt::format("{}.type must be the id of a {}, got {}", section.name,
                                                               to_string(section.kind), type->value.kind_name())));
        return;
      }
      id = type->value.scalar;
      origin = type->value.mark.text();
    }
    chosen.type = registry_.lookup(section.kind, id);
    if (chosen.type == nullptr) problems_.push_back(chosen.mark.error(registry_.why_missing(section.kind, id)));
    config_.origins[section.name + ".type"] = origin;
    (config_.*section.one).type = id;
  }

  void collect_homes() {
    for (const auto& section : plugin_sections()) {
      const auto* type = section.one == nullptr ? nullptr : chosen_[section.name].type;
      if (type == nullptr) continue;
      for (const auto& spec : type->type.params) {
        add_home(spec, section.name, type->type.id);
        collect_nested_homes(spec, node(section.name), section.name);
      }
    }
    for (const auto& [name, specs] : fixed_sections())
      for (const auto& spec : specs) add_home(spec, name);
    homes_["poses"].push_back("layout");
    for (const auto* type : registry_.types(PluginKind::importer))
      for (const auto& spec : type->type.params) add_home(spec, "importers." + type->type.id);
    for (const auto& [member, known] : unknown_top_)
      if (member->key == "force")
        problems_.push_back(member->key_mark.error(
            "the section 'force' is gone: its keys are parameters of the sequence planner 'least_cut'; write "
            "sequence_planner: {type: chain, of: [{type: blocking}, {type: least_cut, candidates: 24}]}, or leave it "
            "out"));
      else
        problems_.push_back(member->key_mark.error(unknown_key_message(member->key, {"", "", ""}, known, homes_)));
    for (const auto* member : unknown_plugins_)
      problems_.push_back(
          member->key_mark.error(unknown_key_message(member->key, {"plugins", "", ""}, {"search_paths"}, homes_)));
  }

  void add_home(const ParamSpec& spec, const std::string& section, const std::string& type = "") {
    homes_[spec.name].push_back(section + (spec.advanced ? ".advanced" : "") +
                                (type.empty() ? "" : fmt::format(" ({})", type)));
  }

  /// Collects the keys of the plugins in one parameter: those that the file names, otherwise the default.
  void collect_nested_homes(const ParamSpec& spec, const ConfigNode* section, const std::string& name) {
    std::vector<std::string> types;
    const ConfigMember* given = section != nullptr && section->is_map() ? section->find(spec.name) : nullptr;
    if (given != nullptr && given->value.kind == ConfigNode::Kind::sequence) {
      for (const ConfigNode& item : given->value.items) types.push_back(named_type(item));
    } else if (const auto* many = std::get_if<std::vector<PluginChoice>>(&spec.fallback)) {
      for (const PluginChoice& choice : *many) types.push_back(choice.type);
    }
    const std::string list = name + "." + spec.name;
    for (const ParamSpec& option : spec.options) add_home(option, "items of " + list);
    for (std::size_t k = 0; k < types.size(); ++k)
      if (const RegisteredType* type = registry_.lookup(spec.plugin_kind, types[k]))
        for (const ParamSpec& own : type->type.params) add_home(own, fmt::format("{}.{}", list, k), types[k]);
  }

  Binder binder() { return {types_, homes_, config_.origins, problems_, config_.warnings}; }

  void bind_plugin(const PluginSection& section) {
    const ConfigNode* map = node(section.name);
    const auto* type = chosen_[section.name].type;
    if (type == nullptr) {  // its keys cannot be checked, only that the section is a map
      if (map != nullptr && !map->is_map())
        problems_.push_back(
            map->mark.error(fmt::format("{} must be a map of keys, not {}", section.name, map->kind_name())));
      return;
    }
    (config_.*section.one).parameters = binder().section(
        type->type.params, map, {section.name, type->type.id, source_text(*type)}, default_origin(*type));
  }

  /// `importers`: a map from ids to maps of parameters. Every importer is used, also without an entry.
  void bind_importers() {
    const ConfigNode* section = node("importers");
    if (section != nullptr && !section->is_map()) {
      problems_.push_back(section->mark.error(
          fmt::format("importers must be a map from ids of importers to their keys, not {}", section->kind_name())));
      section = nullptr;
    }
    for (const auto* type : registry_.types(PluginKind::importer)) {
      const std::string& id = type->type.id;
      const ConfigMember* member = section == nullptr ? nullptr : section->find(id);
      if (type->type.params.empty() && member == nullptr) continue;
      const std::string source =
          fmt::format("{} {}, {}", id, type->file->version, type->file->path.filename().string());
      config_.importers[id] = binder().section(type->type.params, member == nullptr ? nullptr : &member->value,
                                               {"importers." + id, "", source});
    }
    if (section == nullptr) return;
    for (const auto& member : section->members)
      if (registry_.lookup(PluginKind::importer, member.key) == nullptr)
        problems_.push_back(member.key_mark.error(registry_.why_missing(PluginKind::importer, member.key)));
  }

  void check_capabilities() {
    const auto* simulator = chosen_["simulator"].type;
    if (simulator == nullptr) return;
    for (const auto& section : plugin_sections()) {
      if (section.one == nullptr || chosen_[section.name].type == nullptr) continue;
      check_capabilities(section.kind, config_.*section.one, chosen_[section.name].mark, simulator->type);
    }
  }

  /// Checks the chosen type and the plugins in its parameters.
  void check_capabilities(PluginKind kind, const PluginChoice& chosen, const ConfigMark& mark,
                          const PluginType& simulator) {
    const RegisteredType* type = registry_.lookup(kind, chosen.type);
    if (type == nullptr) return;
    const Capabilities& needs = type->type.traits.needs;
    const Capabilities& has = simulator.traits.provides;
    const auto report = [&](const std::string& what) {
      problems_.push_back(mark.error(fmt::format("{} '{}' needs a simulator with {}, which '{}' does not have",
                                                 to_string(kind), chosen.type, what, simulator.id)));
    };
    if (needs.dynamics && !has.dynamics) report("dynamics");
    if (needs.contacts && !has.contacts) report("contacts");
    if (needs.distance && !has.distance) report("distance queries");
    if (needs.max_moving > has.max_moving) report(fmt::format("{} parts moving simultaneously", needs.max_moving));
    for (const ParamSpec& spec : type->type.params) {
      const auto held = chosen.parameters.find(spec.name);
      if (held == chosen.parameters.end()) continue;
      if (const auto* one = std::get_if<PluginChoice>(&held->second))
        check_capabilities(spec.plugin_kind, *one, mark, simulator);
      if (const auto* many = std::get_if<std::vector<PluginChoice>>(&held->second))
        for (const PluginChoice& item : *many) check_capabilities(spec.plugin_kind, item, mark, simulator);
    }
  }

  void check_up(const ConfigNode& layout) {
    const ConfigMember* up = layout.find("up");
    if (up == nullptr || !up->value.is_scalar() || up->value.scalar == "auto" || direction_named(up->value.scalar))
      return;
    problems_.push_back(up->value.mark.error(
        fmt::format("layout.up: '{}' is no direction; write auto, {}", up->value.scalar, kDirectionForms)));
  }

  /// Reads `layout.poses`, a map from part names to poses, and returns the section with the plain parameters only.
  ConfigNode without_poses(const ConfigNode& layout) {
    ConfigNode rest = layout;
    check_up(layout);
    const ConfigMember* poses = layout.find("poses");
    if (poses == nullptr) return rest;
    rest.erase("poses");
    if (!poses->value.is_map()) {
      problems_.push_back(poses->value.mark.error(
          fmt::format("layout.poses must be a map from part names to poses, not {}", poses->value.kind_name())));
      return rest;
    }
    for (const auto& member : poses->value.members)
      if (const auto pose = read_pose(member.value)) {
        config_.layout.poses[member.key] = *pose;
        config_.origins["layout.poses." + member.key] = member.value.mark.text();
      }
    return rest;
  }

  std::optional<Pose> read_pose(const ConfigNode& list) {
    const auto fail = [&](const std::string& what) {
      problems_.push_back(
          list.mark.error(fmt::format("a pose must be seven numbers [x, y, z, qw, qx, qy, qz]{}", what)));
      return std::nullopt;
    };
    if (list.kind != ConfigNode::Kind::sequence) return fail(fmt::format(", not {}", list.kind_name()));
    if (list.items.size() != 7) return fail(fmt::format(", got {}", list.items.size()));
    double n[7] = {};
    for (std::size_t i = 0; i < 7; ++i) {
      const ConfigNode& item = list.items[i];
      const char* end = item.scalar.data() + item.scalar.size();
      const auto read = std::from_chars(item.scalar.data(), end, n[i]);
      if (!item.is_scalar() || item.quoted || read.ec != std::errc{} || read.ptr != end || !std::isfinite(n[i]))
        return fail(fmt::format("; '{}' is none", item.scalar));
    }
    Pose pose{{n[0], n[1], n[2]}, {n[3], n[4], n[5], n[6]}};
    const double norm = pose.q.norm();
    if (!(std::abs(norm - 1) <= 1e-3)) return fail(fmt::format("; the quaternion has length {:.6g}, expected 1", norm));
    if (std::abs(norm - 1) > 1e-12) pose.q.normalize();
    return pose;
  }

  const ConfigNode& root_;
  Registry& registry_;
  std::vector<Diagnostic>& problems_;
  RunConfig config_;
  const TypeSource types_;
  KeyHomes homes_;
  std::map<std::string, Chosen> chosen_;
  std::vector<std::pair<const ConfigMember*, std::vector<std::string>>> unknown_top_;
  std::vector<const ConfigMember*> unknown_plugins_;
};

}  // namespace

RunConfig load_config(const ConfigSource& source, Registry& registry) {
  std::vector<Diagnostic> problems;
  const ConfigNode root = merged_tree(source, problems);
  RunConfig config = Loader(root, registry, problems).load();
  if (!problems.empty()) {
    sort_by_place(problems);
    throw ConfigError(std::move(problems));
  }
  config.assembly = Schema<PrepareOptions>().bind(config.sections.at("assembly"));
  auto poses = std::move(config.layout.poses);
  config.layout = Schema<LayoutOptions>().bind(config.sections.at("layout"));
  config.layout.poses = std::move(poses);
  config.run = Schema<RunSettings>().bind(config.sections.at("run"));
  config.proofs = Schema<ProofOptions>().bind(config.sections.at("immobility"));
  bind_verify_section(config);
  return config;
}

}  // namespace dismantle
