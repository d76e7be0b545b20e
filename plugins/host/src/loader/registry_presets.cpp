// Turns presets into types: the type that a preset names, with other defaults.
#include <fmt/format.h>

#include <algorithm>

#include "config/binder.h"
#include "config/layers.h"
#include "dismantle/host/registry.h"
#include "loader/preset_file.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

/// Adds the needs of the plugins in a parameter. Presets already include those of their nested plugins.
void add_needs(const ParamSpec& spec, const TypeSource& types, Capabilities& needs) {
  std::vector<PluginChoice> held;
  if (const auto* one = std::get_if<PluginChoice>(&spec.fallback)) held = {*one};
  if (const auto* many = std::get_if<std::vector<PluginChoice>>(&spec.fallback)) held = *many;
  for (const PluginChoice& choice : held) {
    const RegisteredType& type = *types.lookup(spec.plugin_kind, choice.type);
    const Capabilities& more = type.type.traits.needs;
    needs.dynamics = needs.dynamics || more.dynamics;
    needs.contacts = needs.contacts || more.contacts;
    needs.distance = needs.distance || more.distance;
    needs.max_moving = std::max(needs.max_moving, more.max_moving);
    for (ParamSpec inner : type.type.params) {
      if (const auto own = choice.parameters.find(inner.name); own != choice.parameters.end())
        inner.fallback = own->second;
      add_needs(inner, types, needs);
    }
  }
}

}  // namespace

fs::path preset_folder(const fs::path& built_in_folder) {
  for (const fs::path& folder :
       {built_in_folder / "presets", (built_in_folder / DISMANTLE_PRESETS_FROM_PLUGINS).lexically_normal()}) {
    std::error_code error;
    if (fs::is_directory(folder, error)) return fs::weakly_canonical(folder, error);
  }
  return {};
}

/// Retries all open presets: some may become usable when more plugins are loaded.
void Registry::resolve_presets() {
  for (const auto& preset : open_presets_)
    std::erase_if(problems_, [&](const PluginProblem& p) { return p.file == preset.second->file; });
  std::vector<std::string> ids;
  for (const auto& [id, preset] : open_presets_) ids.push_back(id);
  for (const auto& id : ids) {
    std::vector<std::string> chain;
    resolve_preset(id, chain);
  }
}

const RegisteredType* Registry::resolve_preset(const std::string& id, std::vector<std::string>& chain) {
  const auto open = open_presets_.find(id);
  if (open == open_presets_.end()) return nullptr;
  PresetFile& preset = *open->second;
  std::vector<Diagnostic> problems = preset.problems;
  std::string cycle;
  chain.push_back(id);
  // A preset may contain other presets, which are resolved first.
  const TypeSource types{[&](PluginKind kind, const std::string& other) -> const RegisteredType* {
                           if (std::find(chain.begin(), chain.end(), other) != chain.end()) return nullptr;
                           const RegisteredType* found = lookup(kind, other);
                           if (found == nullptr && resolve_preset(other, chain) != nullptr) found = lookup(kind, other);
                           return found;
                         },
                         [&](PluginKind kind, const std::string& other) {
                           const auto first = std::find(chain.begin(), chain.end(), other);
                           if (first == chain.end()) return why_missing(kind, other);
                           std::string text = fmt::format("preset '{}' holds itself: ", other);
                           for (auto it = first; it != chain.end(); ++it) text += *it + " -> ";
                           return text + other;
                         }};
  std::map<std::string, std::string> origins;
  std::vector<std::string> warnings;
  std::optional<PluginChoice> choice;
  if (lookup(id) != nullptr)
    problems.push_back({"", 0, 0, fmt::format("the id '{}' is taken by {}", id, lookup(id)->file->path.string())});
  if (problems.empty())
    choice = Binder(types, {}, origins, problems, warnings)
                 .choice(preset.kind, {}, preset.choice, std::string(to_string(preset.kind)), nullptr, "default");
  for (const std::string& warning : warnings) problems.push_back({"", 0, 0, warning});
  chain.pop_back();
  if (!problems.empty()) {
    const auto known =
        std::find_if(problems_.begin(), problems_.end(), [&](const PluginProblem& p) { return p.file == preset.file; });
    if (known == problems_.end())  // not yet reported through a preset that contains it
      problems_.push_back({preset.file, "", {id}, ConfigError(std::move(problems)).what()});
    return nullptr;
  }
  auto made = std::make_unique<RegisteredType>(*types.lookup(preset.kind, choice->type));
  made->preset_of = choice->type;
  made->preset_file = preset.file;
  made->type.id = id;
  made->type.summary = preset.summary;
  for (ParamSpec& spec : made->type.params) {
    spec.fallback = choice->parameters.at(spec.name);
    spec.required = false;
    add_needs(spec, types, made->type.traits.needs);
  }
  const RegisteredType* result = made.get();
  presets_[id] = std::move(made);
  open_presets_.erase(id);
  return result;
}

}  // namespace dismantle
