#include "campaign/enlist.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "dismantle/errors.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/preparation/sha256.h"

namespace dismantle::bench {
namespace {

namespace fs = std::filesystem;

std::string sha256_of(const std::string& text) {
  Sha256 hash;
  hash.add(text);
  return hash.hex();
}

RunConfig with_seed(RunConfig config, std::int64_t seed) {
  config.run.seed = seed;
  config.sections.at("run").at("seed") = seed;
  config.origins.clear();  // the origin of a value does not affect the run
  return config;
}

/// Writes folders as absolute paths, so that the recorded configuration works from any folder.
std::string text_of(const RunConfig& config, const Registry& registry, const fs::path& folder) {
  RunConfig bare = config;
  bare.plugin_search_paths.clear();
  std::string text = resolved_yaml(bare, registry, folder);
  std::string plugins;
  for (const auto& path : config.plugin_search_paths)
    plugins += "    - " + nlohmann::json(fs::absolute(path).lexically_normal().string()).dump() + "\n";
  if (!plugins.empty()) text.insert(text.find("assembly:\n"), "plugins:\n  search_paths:\n" + plugins);
  return text;
}

/// Appends `choice` and the plugins nested in its parameters, each named by its path in the configuration.
void add_uses(const std::string& place, PluginKind kind, const PluginChoice& choice, const Registry& registry,
              std::map<fs::path, std::string>& hashes, std::vector<PluginUse>& out) {
  const RegisteredType& type = registry.find(kind, choice.type);
  std::string& hash = hashes[type.file->path];
  if (hash.empty()) hash = sha256_of_file(type.file->path);
  out.push_back({place, choice.type, type.file->id, type.file->version, type.file->path.filename().string(), hash});
  for (const ParamSpec& spec : type.type.params) {
    const std::string inner = place + "." + spec.name;
    const ParamValue& value = choice.parameters.at(spec.name);
    if (const auto* one = std::get_if<PluginChoice>(&value))
      add_uses(inner, spec.plugin_kind, *one, registry, hashes, out);
    if (const auto* many = std::get_if<std::vector<PluginChoice>>(&value))
      for (std::size_t k = 0; k < many->size(); ++k)
        add_uses(inner + "." + std::to_string(k), spec.plugin_kind, (*many)[k], registry, hashes, out);
  }
}

std::vector<PluginUse> plugins_of(const RunConfig& config, const Registry& registry,
                                  std::map<fs::path, std::string>& hashes) {
  std::vector<PluginUse> out;
  for (const PluginSection& section : plugin_sections())
    if (section.one != nullptr) add_uses(section.name, section.kind, config.*section.one, registry, hashes, out);
  return out;
}

/// A folder name from `name` and a hash of `name` and `recipe`.
std::string folder_name(const std::string& name, const std::string& recipe) {
  std::string out;
  for (const char c : name) {
    const bool good = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' ||
                      c == '-' || c == '_' || c == '=' || c == '(' || c == ')' || c == ',';
    out += good ? c : '_';
  }
  return out.substr(0, 100) + "-" + sha256_of(name + "|" + recipe).substr(0, 12);
}

/// Hash of the files of an assembly, or of the sample's name and values. Files that cannot be read are trials that
/// fail.
std::string hash_of_input(const SuiteAssembly& assembly) {
  Sha256 hash;
  hash.add(assembly.sample);
  for (const auto& [key, value] : assembly.sample_values) hash.add("|" + key + "=" + to_text(value));
  std::vector<fs::path> files;
  std::error_code error;
  if (fs::is_regular_file(assembly.path, error)) files.push_back(assembly.path);
  if (fs::is_directory(assembly.path, error))
    for (const auto& entry : fs::directory_iterator(assembly.path, error))
      if (entry.is_regular_file(error)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    hash.add("|" + file.filename().string() + "|");
    if (::access(file.c_str(), R_OK) == 0) hash.add_file(file);
  }
  return hash.hex();
}

/// The name of a generated assembly contains a hash of its inputs, so that it is never mistaken for another.
std::string input_name(const SuiteAssembly& assembly, const std::string& input_hash, const ImportParameters& importers,
                       bool rotate, std::int64_t seed) {
  std::string recipe = assembly.path.string() + "|" + input_hash;
  for (const auto& [importer, values] : importers)
    for (const auto& [key, value] : values) recipe += fmt::format("|{}.{}={}", importer, key, to_text(value));
  return folder_name(assembly.name + (rotate ? fmt::format("_turned{}", seed) : ""), recipe);
}

}  // namespace

bool is_wanted(const std::string& planner, const std::vector<std::string>& only) {
  return only.empty() || std::find(only.begin(), only.end(), planner) != only.end();
}

void check_planners(const Suite& suite, const std::vector<std::string>& only) {
  std::vector<std::string> names;
  for (const auto& planner : suite.planners) names.push_back(planner.name);
  for (const auto& name : only)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw Error(fmt::format("the suite has no planner '{}'; it has: {}", name, fmt::join(names, ", ")));
}

Enlistment enlist(const Suite& suite, const CampaignOptions& options) {
  const fs::path configs = fs::absolute(options.folder) / "configs";
  check_planners(suite, options.only);
  fs::create_directories(configs);
  Enlistment out;
  struct Known {
    std::string hash;
    fs::path file;
  };
  std::map<std::pair<std::size_t, std::int64_t>, Known> known;
  std::vector<std::string> planner_hashes;
  std::map<fs::path, std::string> hashes;
  out.wanted.replace = options.replace;
  for (const auto& assembly : suite.assemblies) out.wanted.inputs[assembly.name] = hash_of_input(assembly);
  for (const auto& planner : suite.planners) {
    RunConfig bare = with_seed(planner.config, 0);
    bare.plugin_search_paths.clear();  // the hashes of the plugin files are more specific
    planner_hashes.push_back(sha256_of(resolved_yaml(bare, *planner.registry, configs)));
  }
  for (const Cell& cell : shard_of(matrix(suite), options.shard, options.shards)) {
    const SuiteAssembly& assembly = suite.assemblies[cell.assembly];
    const SuiteVariant& variant = suite.variants[cell.variant];
    const SuitePlanner& planner = suite.planners[cell.planner];
    Known& config = known[{cell.planner, cell.seed}];
    if (config.hash.empty()) {
      const RunConfig seeded = with_seed(planner.config, cell.seed);
      const std::string text = text_of(seeded, *planner.registry, configs);
      config.hash = sha256_of(text);
      config.file = configs / (config.hash.substr(0, 16) + ".yaml");
      write_file(config.file, text);
      out.wanted.configs.push_back({config.hash, text, plugins_of(seeded, *planner.registry, hashes)});
    }
    Enlisted trial;
    const Limits& l = suite.limits;
    trial.plan = {.assembly = assembly.name,
                  .variant = variant.name,
                  .planner = planner.name,
                  .seed = cell.seed,
                  .category = assembly.category,
                  .part = variant.part.empty() ? assembly.part : variant.part,
                  .planner_hash = planner_hashes[cell.planner],
                  .config_hash = config.hash,
                  .limit_path_timeout = l.path_timeout,
                  .limit_path_steps = l.path_steps,
                  .limit_timeout = l.timeout,
                  .limit_wall = l.wall_limit(),
                  .limit_cpu = l.cpu_limit(),
                  .limit_memory_mb = l.memory,
                  .threads = l.threads,
                  .verify_max_penetration = suite.max_penetration};
    if (!is_wanted(planner.name, options.only)) {
      out.wanted.others.push_back(trial.plan);
      continue;
    }
    TrialRequest& r = trial.request;
    r.config = config.file;
    r.input = assembly.path;
    r.sample = assembly.sample;
    r.sample_values = assembly.sample_values;
    r.rotate = variant.rotate;
    r.seed = cell.seed;
    r.part = trial.plan.part;
    r.inputs = fs::absolute(options.folder) / "inputs";
    r.input_name = input_name(assembly, out.wanted.inputs.at(assembly.name),
                              import_params_of(planner.config, *planner.registry), variant.rotate, cell.seed);
    r.max_penetration = suite.max_penetration;
    for (const auto& path : planner.config.plugin_search_paths) r.plugins.push_back(fs::absolute(path).string());
    r.search_nodes = static_cast<std::size_t>(suite.search_nodes);
    out.trials.push_back(std::move(trial));
  }
  return out;
}

}  // namespace dismantle::bench
