#include "dismantle/host/registry.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <stdexcept>

#include "dismantle/host/suggest.h"
#include "loader/load_plugin.h"
#include "loader/preset_file.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

fs::path canonical_or_absolute(const fs::path& path) {
  std::error_code error;
  fs::path result = fs::weakly_canonical(path, error);
  if (error || result.empty()) result = fs::absolute(path, error);
  if (result.filename().empty() && result.has_parent_path()) result = result.parent_path();  // trailing slash
  return result;
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& w : words) text += (text.empty() ? "" : ", ") + w;
  return text;
}

std::string with_article(PluginKind kind) {
  const std::string_view name = to_string(kind);
  return fmt::format("{} {}", name.front() == 'i' ? "an" : "a", name);
}

/// Types that come from no file, by id.
struct ProgramTypes {
  std::mutex mutex;
  std::map<std::string, LoadedPlugin> by_id;
};

/// Never destroyed: types may own objects of an interpreter that is gone when the process ends.
ProgramTypes& program_types() {
  static auto* types = new ProgramTypes;
  return *types;
}

}  // namespace

void add_program_type(PluginFile file, PluginType type) {
  std::string text;
  for (const auto& problem : problems_of_types({type}, false)) text += (text.empty() ? "" : "; ") + problem;
  if (!text.empty()) throw PluginError(file.path.string(), text);
  file.types = {type.id};
  const std::string id = type.id;
  ProgramTypes& types = program_types();
  const std::lock_guard lock(types.mutex);
  types.by_id[id] = {std::move(file), {std::move(type)}};
}

std::string_view to_string(PluginKind kind) {
  switch (kind) {
#define DISMANTLE_NAME(name, Interface) \
  case PluginKind::name:                \
    return #name;
    DISMANTLE_PLUGIN_KINDS(DISMANTLE_NAME)
#undef DISMANTLE_NAME
  }
  return "unknown";
}

fs::path built_in_plugin_folder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&built_in_plugin_folder), &info) == 0 || info.dli_fname == nullptr)
    return {};
  return canonical_or_absolute(info.dli_fname).parent_path() / "dismantle" / "plugins";
}

Registry::Registry() : Registry(built_in_plugin_folder()) {
  {
    ProgramTypes& types = program_types();
    const std::lock_guard lock(types.mutex);
    for (const auto& [id, plugin] : types.by_id) accept(plugin);
  }
  const char* paths = std::getenv("DISMANTLE_PLUGIN_PATH");
  std::string_view rest = paths != nullptr ? paths : "";
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    if (colon > 0) add_search_path(fs::path(rest.substr(0, colon)));
    rest.remove_prefix(std::min(colon + 1, rest.size()));
  }
}

Registry::Registry(const fs::path& built_in_folder) {
  if (built_in_folder.empty()) return;
  built_in_folder_ = canonical_or_absolute(built_in_folder);
  add_search_path(built_in_folder_);
}

Registry::~Registry() = default;

void Registry::add_search_path(const fs::path& path) {
  const fs::path clean = canonical_or_absolute(path);
  if (std::find(search_paths_.begin(), search_paths_.end(), clean) == search_paths_.end())
    search_paths_.push_back(clean);
}

void Registry::scan() {
  for (; scanned_paths_ < search_paths_.size(); ++scanned_paths_) {
    const fs::path& path = search_paths_[scanned_paths_];
    std::error_code error;
    const auto status = fs::status(path, error);
    if (fs::is_regular_file(status)) {
      try_load(path);
      continue;
    }
    if (!fs::is_directory(status)) {
      problems_.push_back({path, "", {}, "plugin folder does not exist"});
      continue;
    }
    std::vector<fs::path> files;
    fs::directory_iterator it(path, error);
    for (; !error && it != fs::directory_iterator(); it.increment(error))
      if (it->path().extension() == ".so") files.push_back(it->path());
    if (error) problems_.push_back({path, "", {}, "plugin folder cannot be read: " + error.message()});
    std::sort(files.begin(), files.end());  // the directory order differs between machines
    for (const auto& file : files) try_load(file);
    read_presets_of(path);
  }
  resolve_presets();
}

void Registry::read_presets_of(const fs::path& search_path) {
  const bool built_in = search_path == built_in_folder_;
  const fs::path folder = built_in ? preset_folder(search_path) : search_path / "presets";
  for (auto& preset : read_presets(folder)) {
    if (!built_in && preset->id.find('.') == std::string::npos)
      preset->problems.push_back(
          {"", 0, 0, "the id of a preset outside of the built-in folder must carry a dot, as in 'acme.fast'"});
    const auto [known, is_new] = open_presets_.try_emplace(preset->id, nullptr);
    if (is_new && !presets_.contains(preset->id)) {
      known->second = std::move(preset);
      continue;
    }
    if (is_new) open_presets_.erase(known);
    problems_.push_back(
        {preset->file, "", {preset->id}, fmt::format("preset '{}' is in two files; remove one of them", preset->id)});
  }
}

void Registry::try_load(const fs::path& file) {
  try {
    const fs::path canonical = canonical_or_absolute(file);
    if (known(canonical) != nullptr) return;
    OfferedPlugin offered = read(canonical);
    if (offered.types.empty()) {
      accept(load_plugin(offered));
      return;
    }
    const PluginFile& added = add(offered.file, offered.types);
    unloaded_[&added] = std::make_unique<OfferedPlugin>(std::move(offered));
  } catch (const PluginRefused& refused) {
    problems_.push_back(refused.problem);
  }
}

const PluginFile& Registry::load(const fs::path& file) {
  try {
    const PluginFile& loaded = load_canonical(canonical_or_absolute(file));
    std::string conflicts;
    for (const auto& id : loaded.types) {
      const auto& claim = claims_.at(id);
      if (claim.rivals.empty()) continue;
      const auto* other = claim.file == &loaded ? claim.rivals.front() : claim.file;
      conflicts += fmt::format("{}type id '{}' is also in {}", conflicts.empty() ? "" : "; ", id, other->path.string());
    }
    if (!conflicts.empty()) throw PluginError(loaded.path.string(), conflicts);
    return loaded;
  } catch (const PluginRefused& refused) {
    throw PluginError(refused.problem.file.string(), refused.problem.message);
  }
}

const PluginFile* Registry::known(const fs::path& file) const {
  const auto same = [&](const PluginFile& f) {
    std::error_code error;
    return f.path == file || fs::equivalent(f.path, file, error);
  };
  const auto found = std::find_if(files_.begin(), files_.end(), same);
  return found == files_.end() ? nullptr : &*found;
}

OfferedPlugin Registry::read(const fs::path& file) const {
  return read_plugin(file, !built_in_folder_.empty() && file.parent_path() == built_in_folder_);
}

const PluginFile& Registry::load_canonical(const fs::path& file) {
  if (const PluginFile* found = known(file)) {
    load_now(*found);
    return *found;
  }
  return accept(load_plugin(read(file)));
}

/// Does nothing for a loaded file. A refused file stays unloaded. @throws PluginRefused
void Registry::load_now(const PluginFile& file) const {
  const auto waiting = unloaded_.find(&file);
  if (waiting == unloaded_.end()) return;
  fill(file, load_plugin(*waiting->second));
  unloaded_.erase(waiting);
}

void Registry::try_load_now(const PluginFile& file) const {
  try {
    load_now(file);
  } catch (const PluginRefused& refused) {
    const bool told = std::ranges::any_of(problems_, [&](const PluginProblem& p) {
      return p.file == refused.problem.file && p.message == refused.problem.message;
    });
    if (!told) problems_.push_back(refused.problem);
  }
}

void Registry::load_all() const {
  const std::lock_guard lock(mutex_);
  for (const PluginFile& file : files_) try_load_now(file);
}

const PluginFile& Registry::accept(LoadedPlugin plugin) {
  const PluginFile& added = add(std::move(plugin.file), offers_of(plugin.types));
  fill(added, std::move(plugin));
  return added;
}

/// Adds the types whose ids no other file claimed before.
void Registry::fill(const PluginFile& file, LoadedPlugin plugin) const {
  for (auto& type : plugin.types) {
    Claim& claim = claims_.at(type.id);
    if (claim.file == &file) claim.type = std::make_unique<RegisteredType>(RegisteredType{std::move(type), &file});
  }
}

const PluginFile& Registry::add(PluginFile file, const std::vector<OfferedType>& offers) {
  files_.push_back(std::move(file));
  const PluginFile& added = files_.back();
  for (const OfferedType& type : offers) {
    if (presets_.contains(type.id))
      problems_.push_back({added.path,
                           added.id,
                           {type.id},
                           fmt::format("type id '{}' is the id of a preset, too: {}; remove one of them", type.id,
                                       presets_.at(type.id)->preset_file.string())});
    const auto [known, is_new] = claims_.try_emplace(type.id, Claim{type.kind, &added});
    if (is_new) continue;
    Claim& claim = known->second;
    claim.rivals.push_back(&added);
    problems_.push_back({added.path,
                         added.id,
                         {type.id},
                         fmt::format("type id '{}' is in two files: {} and {}; remove one of them", type.id,
                                     claim.file->path.string(), added.path.string())});
  }
  return added;
}

std::vector<const RegisteredType*> Registry::types(PluginKind kind) const {
  const std::lock_guard lock(mutex_);
  std::vector<const RegisteredType*> found;
  for (const auto& [id, claim] : claims_) {
    if (claim.kind != kind || !claim.rivals.empty()) continue;
    try_load_now(*claim.file);
    if (claim.type != nullptr) found.push_back(claim.type.get());
  }
  for (const auto& [id, preset] : presets_)
    if (preset->type.kind == kind) found.push_back(preset.get());
  std::sort(found.begin(), found.end(), [](const auto* a, const auto* b) { return a->type.id < b->type.id; });
  return found;
}

const RegisteredType* Registry::lookup(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  if (const auto preset = presets_.find(id); preset != presets_.end()) return preset->second.get();
  const auto it = claims_.find(id);
  if (it == claims_.end() || !it->second.rivals.empty()) return nullptr;
  try_load_now(*it->second.file);
  return it->second.type.get();
}

const RegisteredType* Registry::lookup(PluginKind kind, const std::string& id) const {
  const auto* type = lookup(id);
  return type != nullptr && type->type.kind == kind ? type : nullptr;
}

std::string Registry::refused_files_text(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  std::string text;
  for (const auto& problem : problems_) {
    const bool known = std::find(problem.types.begin(), problem.types.end(), id) != problem.types.end();
    if (known) return fmt::format("; {} offers it, but was refused: {}", problem.file.string(), problem.message);
    if (problem.types.empty())  // its types are unknown: the wanted one may be among them
      text += fmt::format("\n  not loaded: {}: {}", problem.file.string(), problem.message);
  }
  return text;
}

std::string Registry::missing_text(std::string_view what, const std::string& id,
                                   const std::vector<std::string>& known) const {
  const std::lock_guard lock(mutex_);
  const auto it = claims_.find(id);
  if (it != claims_.end() && !it->second.rivals.empty())
    return fmt::format("{} '{}' is in two files: {} and {}; remove one of them", what, id,
                       it->second.file->path.string(), it->second.rivals.front()->path.string());
  std::string text = fmt::format("unknown {} '{}'", what, id);
  if (const auto advice = advice_for_removed(id); !advice.empty())
    text += fmt::format("; {}", advice);
  else if (const auto near = nearest(id, known))
    text += fmt::format("; did you mean '{}'?", *near);
  else if (known.empty())
    text += fmt::format("; no {} was found", what);
  else
    text += "; there are: " + listed(known);
  const std::string refused = refused_files_text(id);
  if (refused.empty() && id.find('.') != std::string::npos)  // of a third party
    text += "; its plugin is not in the folders of DISMANTLE_PLUGIN_PATH, or of `plugins: {search_paths: [...]}`";
  return text + refused;
}

std::string Registry::why_missing(PluginKind kind, const std::string& id) const {
  const auto* other = lookup(id);
  if (other != nullptr && other->type.kind != kind)
    return fmt::format("'{}' is {}, not {}", id, with_article(other->type.kind), with_article(kind));
  std::vector<std::string> known;
  for (const auto* type : types(kind)) known.push_back(type->type.id);
  return missing_text(to_string(kind), id, known);
}

std::string Registry::why_missing(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> known;
  for (const auto& [name, claim] : claims_)
    if (claim.rivals.empty()) known.push_back(name);
  for (const auto& [name, preset] : presets_) known.push_back(name);
  return missing_text("plugin type", id, known);
}

const RegisteredType& Registry::find(PluginKind kind, const std::string& id) const {
  const auto* type = lookup(kind, id);
  if (type == nullptr) throw PluginError("", why_missing(kind, id));
  return *type;
}

const RegisteredType& Registry::find(const std::string& id) const {
  const auto* type = lookup(id);
  if (type == nullptr) throw PluginError("", why_missing(id));
  return *type;
}

std::shared_ptr<void> Registry::create_object(PluginKind kind, const std::string& id, const ParamSet& given) const {
  const RegisteredType& found = find(kind, id);
  const auto fail = [&](const std::string& problem) {
    throw PluginError(found.file->path.string(), fmt::format("cannot make {} '{}': {}", to_string(kind), id, problem));
  };
  std::shared_ptr<void> object;
  try {
    object = found.type.create(complete(found.type.params, given), [this](PluginKind of, const PluginChoice& choice) {
      return create_object(of, choice.type, choice.parameters);
    });
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    fail(e.what());
  } catch (...) {
    fail("it threw something that is no std::exception");
  }
  if (object == nullptr) fail("the plugin returned nothing");
  return object;
}

}  // namespace dismantle
