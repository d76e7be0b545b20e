/// Finds plugin files, refuses incompatible ones, and creates objects of their types.
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

/// The name of the kind, as in DISMANTLE_PLUGIN_KINDS: "path_planner".
DISMANTLE_API std::string_view to_string(PluginKind kind);

/// A plugin file that was accepted.
struct PluginFile {
  std::filesystem::path path;  ///< absolute, symbolic links resolved
  std::string id, version, licence, url;
  bool built_in = false;           ///< from the install's own folder
  std::vector<std::string> types;  ///< ids of its types, in the order of registration
};

/// A file or folder that could not be used. Lists show it as a warning; asking for one of its types is an error.
struct PluginProblem {
  std::filesystem::path file;
  std::string plugin_id;           ///< empty when it could not be read
  std::vector<std::string> types;  ///< ids of its types, as far as known
  std::string message;             ///< which item is wrong, both values, what to do
};

/// A type and the file that it came from. A preset is also a registered type: an existing type under its own id, with
/// other defaults (docs/configuration.md).
struct RegisteredType {
  PluginType type;
  const PluginFile* file = nullptr;
  std::string preset_of{};              ///< id of the type that a preset stands for; empty: no preset
  std::filesystem::path preset_file{};  ///< empty: no preset
};

/// The folder that belongs to this copy of Dismantle: `<folder of libdismantle_plugins>/dismantle/plugins`.
DISMANTLE_API std::filesystem::path built_in_plugin_folder();
/// The folder of the presets that belong to a folder of built-in plugins: its subfolder `presets` (a link to
/// `configs/presets` in a build tree), or `configs/presets` of the install's share folder. Empty when neither exists.
DISMANTLE_API std::filesystem::path preset_folder(const std::filesystem::path& built_in_folder);

struct PresetFile;
struct LoadedPlugin;
struct OfferedPlugin;
struct OfferedType;

/// Adds a type that comes from the program and not from a plugin file, as language bindings do. Every Registry that is
/// default-constructed afterwards contains it; a type with the same id replaces the earlier one. `file`: path of the
/// source and the plugin facts that descriptions show. May be called from any thread.
/// @throws PluginError that lists all problems of the type (its id must contain a dot).
DISMANTLE_API void add_program_type(PluginFile file, PluginType type);

/// All available plugin types. A file that lists its types (OFFERS of dismantle_add_plugin) is loaded when one of them
/// is first requested, because most runs use a third of the plugins and none of the libraries that the others link.
/// Libraries stay loaded until the process ends. After the last scan() or load(), const functions may be called from
/// several threads, except problems(), which grows when a file cannot be loaded.
class DISMANTLE_API Registry {
 public:
  /// Contains the types of add_program_type(). Searches the built-in folder, then the folders of
  /// `$DISMANTLE_PLUGIN_PATH` (colon separated).
  Registry();
  /// Searches only `built_in_folder` (nothing when empty). Ids of types found elsewhere must contain a dot.
  explicit Registry(const std::filesystem::path& built_in_folder);
  ~Registry();
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  /// Appends a folder (all its `*.so`, in name order) or one file. Adding a path twice changes nothing.
  void add_search_path(const std::filesystem::path& path);
  /// Scans all search paths not scanned before for plugin files and presets. Presets are `presets/<kind>/<id>.yaml` in
  /// a search path (for built-in plugins: in preset_folder()). Bad files are added to problems() and never throw.
  void scan();
  /// Loads all files that were found but not loaded yet, so that problems() is complete.
  void load_all() const;
  /// Loads one file. Loading it again is no error. @throws PluginError with the reason for a refusal.
  const PluginFile& load(const std::filesystem::path& file);

  /// All usable types of a kind, by id.
  std::vector<const RegisteredType*> types(PluginKind kind) const;
  /// nullptr when there is no such type, or when two files claim the id.
  const RegisteredType* lookup(PluginKind kind, const std::string& id) const;
  /// Looks in all kinds: ids are unique across kinds.
  const RegisteredType* lookup(const std::string& id) const;
  /// Explains why lookup() found nothing: a likely spelling, the actual kind of the id, or the refused file.
  std::string why_missing(PluginKind kind, const std::string& id) const;
  /// The same for `plugins describe ID`, where the kind does not matter.
  std::string why_missing(const std::string& id) const;
  /// @throws PluginError with why_missing().
  const RegisteredType& find(PluginKind kind, const std::string& id) const;
  const RegisteredType& find(const std::string& id) const;

  /// Creates an object of type `id`; parameters that are not given have their defaults. This registry also creates the
  /// plugins that the parameters name, and must outlive the object.
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
  std::deque<PluginFile> files_;        // deque: addresses stay valid
  mutable std::recursive_mutex mutex_;  // guards the members that grow when a file is loaded late
  mutable std::map<std::string, Claim> claims_;
  mutable std::map<const PluginFile*, std::unique_ptr<OfferedPlugin>> unloaded_;
  mutable std::vector<PluginProblem> problems_;
  std::map<std::string, std::unique_ptr<PresetFile>> open_presets_;  // by id; not resolved yet
  std::map<std::string, std::unique_ptr<RegisteredType>> presets_;
};

}  // namespace dismantle
