/// Finds plugin files, refuses those that do not fit, and creates objects of their types.
#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "dismantle/errors.h"
#include "dismantle/export.h"
#include "dismantle/plugin.h"

namespace dismantle {

/// The key of the kind in a configuration: "simulator", "path_planner", "sequence_planner",
/// "transfer_planner", "immobility_prover", "importer".
DISMANTLE_API std::string_view to_string(PluginKind kind);

/// A plugin file that was accepted.
struct PluginFile {
  std::filesystem::path path;  ///< absolute, symbolic links resolved
  std::string id, version, licence, url;
  bool built_in = false;           ///< from the install's own folder
  std::vector<std::string> types;  ///< ids of its types, in the order of registration
};

/// A file or folder that could not be used. A warning in a list, an error when what it holds is asked for.
struct PluginProblem {
  std::filesystem::path file;
  std::string plugin_id;           ///< empty when it could not be read
  std::vector<std::string> types;  ///< ids that it would have offered, as far as known
  std::string message;             ///< which item is wrong, both values, what to do
};

/// A type and the file that it came from. A preset is one, too: another type under an id of its own, with other
/// defaults (docs/configuration.md).
struct RegisteredType {
  PluginType type;
  const PluginFile* file = nullptr;
  std::string preset_of{};              ///< id of the type that a preset stands for; empty: no preset
  std::filesystem::path preset_file{};  ///< of a preset
};

/// The folder that belongs to this copy of Dismantle: `<folder of libdismantle_plugins>/dismantle/plugins`.
DISMANTLE_API std::filesystem::path built_in_plugin_folder();
/// Where the presets are that belong to a folder of built-in plugins: `presets` in it (a link to `configs/presets` in a
/// build tree), or `configs/presets` of the install's share folder. Empty when there are none.
DISMANTLE_API std::filesystem::path preset_folder(const std::filesystem::path& built_in_folder);

struct PresetFile;
struct LoadedPlugin;
struct OfferedPlugin;
struct OfferedType;

/// A type that the program brings itself, not a plugin file: what a language binding registers. Every Registry that the
/// default constructor makes from now on has it; one of the same id replaces the earlier one. `file`: where its source
/// is, and what is said of the plugin in descriptions. May be called from any thread.
/// @throws PluginError with everything that is wrong with the type (its id must carry a dot).
DISMANTLE_API void add_program_type(PluginFile file, PluginType type);

/// What there is to choose from. A file that lists what it offers (OFFERS of dismantle_add_plugin) is loaded when one
/// of its types is first asked for, since most runs use a third of the plugins and none of what the others are linked
/// with. Libraries stay loaded to the end of the process. After the last scan() or load(), const functions may be
/// called from several threads, but for problems(), which grows when a file turns out to be bad.
class DISMANTLE_API Registry {
 public:
  /// Has the types of add_program_type(); searches the built-in folder, then the folders of `$DISMANTLE_PLUGIN_PATH`
  /// (colon separated).
  Registry();
  /// Searches `built_in_folder` alone (nothing when empty). Ids of types found elsewhere must carry a dot.
  explicit Registry(const std::filesystem::path& built_in_folder);
  ~Registry();
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  /// Appends a folder (all its `*.so`, in name order) or one file. Adding a path twice changes nothing.
  void add_search_path(const std::filesystem::path& path);
  /// Finds what the search paths hold and was not looked at before: plugin files, and presets, which are
  /// `presets/<kind>/<id>.yaml` in a search path (of the built-in plugins: preset_folder()). Never throws because of a
  /// bad file: see problems().
  void scan();
  /// Loads all files that were found and not needed until now, so that problems() is complete.
  void load_all() const;
  /// Loads one file. The same file again is no error. @throws PluginError saying why it is refused.
  const PluginFile& load(const std::filesystem::path& file);

  /// All usable types of a kind, by id.
  std::vector<const RegisteredType*> types(PluginKind kind) const;
  /// nullptr when there is none (or when two files claim the id).
  const RegisteredType* lookup(PluginKind kind, const std::string& id) const;
  /// Of any kind: ids are unique over all kinds.
  const RegisteredType* lookup(const std::string& id) const;
  /// Why lookup() found nothing: a likely spelling, the kind that the id has, the file that was refused.
  std::string why_missing(PluginKind kind, const std::string& id) const;
  /// The same for `plugins describe ID`, where the kind does not matter.
  std::string why_missing(const std::string& id) const;
  /// @throws PluginError with why_missing().
  const RegisteredType& find(PluginKind kind, const std::string& id) const;
  const RegisteredType& find(const std::string& id) const;

  /// Makes an object of type `id`; parameters that are not given have their defaults. Plugins that its parameters hold
  /// are made by this registry, which has to outlive the object.
  /// @throws PluginError: no such type, unknown or bad parameter, or the plugin threw.
  template <class Interface>
  std::shared_ptr<Interface> create(const std::string& id, const ParamSet& given = {}) const {
    return std::static_pointer_cast<Interface>(create_object(PluginKindOf<Interface>::value, id, given));
  }

  const std::deque<PluginFile>& files() const { return files_; }
  const std::vector<PluginProblem>& problems() const { return problems_; }
  const std::vector<std::filesystem::path>& search_paths() const { return search_paths_; }

 private:
  struct Claim {
    PluginKind kind;
    const PluginFile* file;
    std::unique_ptr<RegisteredType> type{};   // null: not loaded yet, or refused
    std::vector<const PluginFile*> rivals{};  // further files that claim the same id
  };
  std::shared_ptr<void> create_object(PluginKind kind, const std::string& id, const ParamSet& given) const;
  const PluginFile& load_canonical(const std::filesystem::path& file);
  const PluginFile* known(const std::filesystem::path& file) const;
  OfferedPlugin read(const std::filesystem::path& file) const;
  const PluginFile& accept(LoadedPlugin plugin);
  const PluginFile& add(PluginFile file, const std::vector<OfferedType>& offers);
  void fill(const PluginFile& file, LoadedPlugin plugin) const;
  void load_now(const PluginFile& file) const;
  void try_load_now(const PluginFile& file) const;
  void try_load(const std::filesystem::path& file);
  void read_presets_of(const std::filesystem::path& search_path);
  void resolve_presets();
  const RegisteredType* resolve_preset(const std::string& id, std::vector<std::string>& chain);
  std::string refused_files_text(const std::string& id) const;
  std::string missing_text(std::string_view what, const std::string& id, const std::vector<std::string>& known) const;

  std::filesystem::path built_in_folder_;
  std::vector<std::filesystem::path> search_paths_;
  std::size_t scanned_paths_ = 0;
  std::deque<PluginFile> files_;        // addresses stay
  mutable std::recursive_mutex mutex_;  // of what grows when a file is loaded late
  mutable std::map<std::string, Claim> claims_;
  mutable std::map<const PluginFile*, std::unique_ptr<OfferedPlugin>> unloaded_;
  mutable std::vector<PluginProblem> problems_;
  std::map<std::string, std::unique_ptr<PresetFile>> open_presets_;  // by id; not resolved until now
  std::map<std::string, std::unique_ptr<RegisteredType>> presets_;
};

}  // namespace dismantle
