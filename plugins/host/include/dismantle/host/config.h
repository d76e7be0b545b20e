/// Reads YAML and command line into the typed settings of a run. Formats and messages: docs/configuration.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/engine/layout.h"
#include "dismantle/engine/proof_options.h"
#include "dismantle/engine/run.h"
#include "dismantle/export.h"
#include "dismantle/host/config_node.h"
#include "dismantle/host/registry.h"
#include "dismantle/parameters.h"
#include "dismantle/path_oracle.h"
#include "dismantle/preparation/components.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// The `run:` section.
struct RunSettings {
  std::int64_t seed = 1;
  unsigned threads = 0;         ///< 0 = all cores
  double path_timeout = 120;    ///< seconds per attempt, 0 = none
  std::int64_t path_steps = 0;  ///< simulated steps per attempt, 0 = none
  double timeout = 7200;        ///< seconds for the whole run, 0 = none
  ForceWhen force = ForceWhen::last_resort;
  bool best_order = true;  ///< a planner that does not follow the objective by `best_order` is put into one
  double grace = 30;       ///< seconds that plugins have for stopping after a request to stop, 0 = no limit
  DISMANTLE_API static void describe(Schema<RunSettings>& s);
};

/// What an item of `objective:` says beside the parameters of its check.
struct ObjectiveOptions {
  double weight = 1;
  bool require = false;
  DISMANTLE_API static void describe(Schema<ObjectiveOptions>& s);
};

/// Two parts that may penetrate each other by `depth` (input units, >= 0), whatever their initial overlap.
struct NamedOverlap {
  std::string a, b;
  double depth = 0;
  bool operator==(const NamedOverlap&) const = default;
};

/// A forced step that the user accepts: `part` and `against` may cut into each other by `depth` (input units, > 0).
struct NamedAcceptance {
  std::string part, against, as;
  double depth = 0;
  bool operator==(const NamedAcceptance&) const = default;
};

/// The user's constraints on the order, by part names. See Constraints.
struct NamedConstraints {
  std::vector<std::string> base;
  std::vector<std::vector<std::string>> together;
  std::vector<std::vector<std::string>> before;  ///< each list in the order in which its parts must leave
  std::string target;                            ///< empty: none
  std::vector<std::string> ignore;               ///< parts left out of the assembly
  std::vector<std::string> flexible;             ///< parts that others may cut into: springs, belts, cables, O-rings
  std::vector<NamedOverlap> overlap;             ///< pairs that may penetrate each other
  std::vector<NamedAcceptance> accept{};         ///< forced steps that are as they should be: snap fits, press fits
  bool operator==(const NamedConstraints&) const = default;
};
/// Sets InitialOverlap::declared of the pairs that `overlap` and `flexible` name. Throws like constraints_of().
DISMANTLE_API void declare_overlaps(const NamedConstraints& named, Assembly& assembly);
/// @throws InputError that names every unknown part.
DISMANTLE_API Constraints constraints_of(const NamedConstraints& named, const Assembly& assembly);

/// What the user states of parts: an entry of the section `parts:`. Empty members are not stated.
struct StatedPart {
  std::string pattern;             ///< of names of parts: '*' stands for any text, '?' for one character
  std::string kind{}, size{};      ///< see PartKind; `size` of a screw without its length
  std::optional<double> length{};  ///< mm, > 0
  std::optional<double> torque{};  ///< N m, > 0
  std::string glue{};
  Diagnostic place{};  ///< without a message
};
/// Sets Part::kind of the parts that the patterns match; later entries win. Call it after the kinds were recognised:
/// what is not stated stays. @throws ConfigError with every pattern that matches no part, and its place.
DISMANTLE_API void state_kinds(const std::vector<StatedPart>& stated, Assembly& assembly);

/// A name in the `constraints:` or `components:` section and its place.
struct ConstraintName {
  std::string key;   ///< "before"
  std::string name;  ///< of a part; a pattern of products
  Diagnostic place;  ///< without a message
};

/// All settings of a run. The same RunConfig and input give the same plan.
struct RunConfig {
  /// Parameters are complete, also those of nested plugins.
  PluginChoice simulator, path_planner, sequence_planner, transfer_planner;
  std::vector<PluginChoice> provers;    ///< immobility provers in the order in which they are asked; empty: no proofs
  std::vector<PluginChoice> objective;  ///< step checks; their options are ObjectiveOptions; empty: none
  PrepareOptions assembly;
  RunSettings run;
  VerifyOptions verify;
  double named_overlap = 0.1;  ///< as RunOptions::named_overlap
  ProofOptions proofs;
  LayoutOptions layout;
  NamedConstraints constraints;
  std::vector<ConstraintName> constraint_names;  ///< in reading order
  ComponentChoice components;
  std::vector<ConstraintName> component_names;  ///< in reading order
  std::vector<StatedPart> parts{};              ///< in reading order
  std::map<std::string, ParamSet> importers;    ///< complete parameters by id; only importers with parameters
  std::vector<std::filesystem::path> plugin_search_paths;  ///< relative to the working directory, not to the file

  /// The untyped values of fixed_sections() and `immobility`; complete except for `layout.poses` and
  /// `immobility.provers`.
  std::map<std::string, ParamSet> sections;
  /// "run.seed" -> "configs/a.yaml:4", "<--set>:1", "<--seed>" or "default".
  std::map<std::string, std::string> origins;
  std::vector<std::string> warnings;  ///< "run.yaml:4:3: ...": keys that are read, but should be written otherwise
};

/// An option of the command line that stands for a key: {"--seed", "run.seed", "7"}.
struct ConfigOption {
  std::string flag;
  std::string key;
  std::string value;
  bool adds = false;  ///< to the list that is the value of the key
};

/// The sources of a configuration: a file and overrides.
struct ConfigSource {
  std::optional<std::filesystem::path> file{};  ///< none: defaults only
  std::vector<std::string> set{};               ///< "path_planner.goal_bias=0.1"; the value is YAML
  std::vector<ConfigOption> options{};          ///< values are taken literally
  std::vector<ConfigMember> sections{};         ///< of another file, such as a suite; messages name their places in it
};

/// Reads, merges and checks a configuration. Adds its search paths to `registry` and scans it.
/// @throws ConfigError with all errors.
DISMANTLE_API RunConfig load_config(const ConfigSource& source, Registry& registry);

/// Checks that all names in `constraints` are in `parts`, the names of the input's parts. @throws ConfigError with
/// every unknown name, its place and the nearest known name.
DISMANTLE_API void check_constraint_names(const RunConfig& config, const std::vector<std::string>& parts,
                                          const std::string& input);

/// Checks that each pattern in `components` matches one of `products`. @throws ConfigError likewise.
DISMANTLE_API void check_component_names(const RunConfig& config, const std::vector<std::string>& products,
                                         const std::string& input);

/// The parameters in `config.importers` that differ from the defaults.
DISMANTLE_API ImportParameters import_params_of(const RunConfig& config, const Registry& registry);

/// The configuration as a file that gives the same RunConfig when it is loaded again. Comments state the origin of
/// every value, and version and hash of the plugins. `folder`: folder of the file to write; search paths are relative
/// to it.
DISMANTLE_API std::string resolved_yaml(const RunConfig& config, const Registry& registry,
                                        const std::filesystem::path& folder);

/// Names and parameter declarations of the sections with fixed parameters, in the order of the file.
DISMANTLE_API const std::vector<std::pair<std::string, std::vector<ParamSpec>>>& fixed_sections();
/// A section that chooses plugins of one kind: one plugin, or a list of them.
struct PluginSection {
  std::string name;  ///< of the section
  PluginKind kind;
  std::vector<std::string> defaults;       ///< ids; of a list: those that are available
  PluginChoice RunConfig::*one = nullptr;  ///< null: a list
  std::vector<PluginChoice> RunConfig::*many = nullptr;
  std::string list{};                ///< key of the list in its section; empty: the section itself is the list
  std::string doc{};                 ///< of the list
  std::vector<ParamSpec> options{};  ///< keys of each item of the list, beside the parameters of its type
  std::vector<ParamSpec> beside{};   ///< keys of the section beside the list
  std::vector<ParamSet>
      default_options{};  ///< by id of `defaults`: what its item says beside parameters; empty: nothing
  /// "path_planner", "immobility.provers".
  std::string key() const { return list.empty() ? name : name + "." + list; }
};
/// The sections that choose plugins, in the order of the file. A new kind of plugin is one entry, and a member of
/// RunConfig. (`importers` chooses nothing: all of them are used.)
DISMANTLE_API const std::vector<PluginSection>& plugin_sections();
/// The declaration of the list of a section.
DISMANTLE_API ParamSpec plugin_list(const PluginSection& section, const Registry& registry);
/// All keys of a section with a list: the list, and those beside it.
DISMANTLE_API std::vector<ParamSpec> list_section(const PluginSection& section, const Registry& registry);
/// The types that a list names by default, if they are available.
DISMANTLE_API std::vector<PluginChoice> default_list(std::vector<PluginChoice> RunConfig::*list,
                                                     const Registry& registry);
inline constexpr std::int64_t kConfigSchema = 1;  ///< the value of the key `schema`

}  // namespace dismantle
