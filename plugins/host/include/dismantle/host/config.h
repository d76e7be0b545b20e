/// YAML and the command line into typed settings of a run. Formats and messages: docs/configuration.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/engine/force_options.h"
#include "dismantle/engine/layout.h"
#include "dismantle/engine/proof_options.h"
#include "dismantle/export.h"
#include "dismantle/host/registry.h"
#include "dismantle/parameters.h"
#include "dismantle/path_oracle.h"
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
  double grace = 30;  ///< seconds that plugins have to stop after they were asked to, 0 = no limit
  DISMANTLE_API static void describe(Schema<RunSettings>& s);
};

/// Two parts that may be in each other by `depth` (input units, >= 0), whatever they overlap when assembled.
struct NamedOverlap {
  std::string a, b;
  double depth = 0;
  bool operator==(const NamedOverlap&) const = default;
};

/// What the user asks of the order, by names of parts. See Constraints.
struct NamedConstraints {
  std::vector<std::string> base;
  std::vector<std::vector<std::string>> together;
  std::vector<std::vector<std::string>> before;  ///< each in the order in which they are to leave
  std::string target;                            ///< empty: none
  std::vector<std::string> ignore;               ///< parts that are left out of the assembly
  std::vector<std::string> flexible;             ///< parts that others may cut into: springs, belts, cables, O-rings
  std::vector<NamedOverlap> overlap;             ///< pairs that may be in each other
  bool operator==(const NamedConstraints&) const = default;
};
/// Sets InitialOverlap::declared of the pairs that `overlap` and `flexible` name. @throws InputError as
/// constraints_of().
DISMANTLE_API void declare_overlaps(const NamedConstraints& named, Assembly& assembly);
/// @throws InputError naming every part that is not there.
DISMANTLE_API Constraints constraints_of(const NamedConstraints& named, const Assembly& assembly);

/// A name in the `constraints:` section and where it stands.
struct ConstraintName {
  std::string key;   ///< "before"
  std::string name;  ///< of a part
  Diagnostic place;  ///< without a message
};

/// All settings of a run. The same RunConfig and input give the same plan.
struct RunConfig {
  /// With complete parameters, those of the plugins that they hold included.
  PluginChoice simulator, path_planner, sequence_planner, transfer_planner;
  std::vector<PluginChoice> provers;  ///< of immobility, in the order of asking; empty: nothing is proved
  PrepareOptions assembly;
  RunSettings run;
  VerifyOptions verify;
  double named_overlap = 0.1;  ///< as RunOptions::named_overlap
  ProofOptions proofs;
  ForceOptions force;  ///< `when` is run.force
  LayoutOptions layout;
  NamedConstraints constraints;
  std::vector<ConstraintName> constraint_names;            ///< in reading order
  std::map<std::string, ParamSet> importers;               ///< complete, by id; only importers that have parameters
  std::vector<std::filesystem::path> plugin_search_paths;  ///< made relative to the working directory, not to the file

  /// The untyped values of the sections `assembly`, `layout`, `run`, `verify`, `immobility`; complete (but for
  /// `layout.poses` and `immobility.provers`).
  std::map<std::string, ParamSet> sections;
  /// "run.seed" -> "configs/a.yaml:4", "<--set>:1", "<--seed>" or "default".
  std::map<std::string, std::string> origins;
};

/// An option of the command line that stands for a key: {"--seed", "run.seed", "7"}.
struct ConfigOption {
  std::string flag;
  std::string key;
  std::string value;
};

/// What a configuration is made of: a file, and what overrides it.
struct ConfigSource {
  std::optional<std::filesystem::path> file;  ///< none: defaults only
  std::vector<std::string> set;               ///< "path_planner.goal_bias=0.1"; the value is YAML
  std::vector<ConfigOption> options;          ///< values are taken literally
};

/// Reads, merges and checks. Adds the configuration's search paths to `registry` and scans it.
/// @throws ConfigError with everything that is wrong.
DISMANTLE_API RunConfig load_config(const ConfigSource& source, Registry& registry);

/// Are all names in `constraints` among `parts`, the names of the input's parts? @throws ConfigError with every name
/// that is not, its place, and the nearest one that there is.
DISMANTLE_API void check_constraint_names(const RunConfig& config, const std::vector<std::string>& parts,
                                          const std::string& input);

/// The configuration as a file that gives the same RunConfig when it is loaded again: every value, with where it
/// came from, and the plugins with version and hash as comments. `folder`: where the file will lie
/// (search paths are written relative to it).
DISMANTLE_API std::string resolved_yaml(const RunConfig& config, const Registry& registry,
                                        const std::filesystem::path& folder);

/// The sections with fixed parameters: name and declarations of `assembly`, `layout`, `run`, `verify`.
DISMANTLE_API const std::vector<std::pair<std::string, std::vector<ParamSpec>>>& fixed_sections();
/// The sections that choose a plugin, with the id that is taken when none is named.
struct PluginSection {
  const char* name;
  PluginKind kind;
  const char* default_id;
};
/// The sections that name a plugin, in the order of the file.
DISMANTLE_API const std::vector<PluginSection>& plugin_sections();
/// The parameter `provers` of the section `immobility`. Its default: the built-in provers, as far as they are there.
DISMANTLE_API ParamSpec provers_parameter(const Registry& registry);
/// All parameters of the section `immobility:`.
DISMANTLE_API std::vector<ParamSpec> immobility_parameters(const Registry& registry);
inline constexpr std::int64_t kConfigSchema = 1;  ///< the value of the key `schema`

}  // namespace dismantle
