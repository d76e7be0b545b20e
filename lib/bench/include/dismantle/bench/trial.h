/// One trial, as its processes see it: they read and write files. One process plans, another one verifies.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/parameters.h"

namespace dismantle::bench {

struct TrialRequest {
  std::filesystem::path config;  ///< the resolved configuration, seed and limits included
  std::filesystem::path input;   ///< empty for a sample
  std::string sample;
  ParamSet sample_values;
  bool rotate = false;
  std::int64_t seed = 1;
  std::string part;                  ///< empty: the whole assembly
  std::filesystem::path inputs;      ///< folder for generated assemblies: samples, rotated ones, translated ones
  std::string input_name;            ///< name of a generated assembly in `inputs`
  double max_penetration = 0;        ///< the verifier's tolerance, for an assembly of size 10
  std::vector<std::string> plugins;  ///< plugins.search_paths of the planner, for the verifier
  std::size_t search_nodes = 0;      ///< nodes of search trees that the trial keeps
};

/// The files in the folder of a trial.
struct TrialFiles {
  explicit TrialFiles(const std::filesystem::path& folder)
      : request(folder / "request.json"),
        result(folder / "result.json"),
        progress(folder / "progress.txt"),
        searches(folder / "searches.txt"),
        plan(folder / "plan.json"),
        verification(folder / "verification.json") {}
  std::filesystem::path request;
  std::filesystem::path result;    ///< absent when the trial was killed or crashed
  std::filesystem::path progress;  ///< a line "seconds removed" per step
  std::filesystem::path searches;  ///< what the searches for paths recorded: search_records.h
  std::filesystem::path plan;      ///< also saved during planning
  std::filesystem::path verification;
};

/// Exit status of a trial that ran out of memory: it ends at the first allocation that fails.
inline constexpr int kOutOfMemory = 86;

DISMANTLE_API void write_request(const TrialRequest& request, const std::filesystem::path& folder);

/// Executes the request in `folder`. @throws ConfigError, InputError, PluginError as `dismantle plan` does.
DISMANTLE_API void plan_trial(const std::filesystem::path& folder);
/// Verifies the plan in `folder`. Call it in a process that has not loaded any planner.
DISMANTLE_API void verify_trial(const std::filesystem::path& folder);

}  // namespace dismantle::bench
