/// One trial, as its processes see it: files in, files out. A process plans, another one verifies.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

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
  std::string part;               ///< empty: the whole assembly
  std::filesystem::path inputs;   ///< folder for assemblies that are made: samples, turned ones, moved ones
  std::string input_name;         ///< of such an assembly in that folder
  double max_penetration = 0.01;  ///< of an assembly of size 10; for the verifier
};

/// The files in the folder of a trial.
struct TrialFiles {
  explicit TrialFiles(const std::filesystem::path& folder)
      : request(folder / "request.json"),
        result(folder / "result.json"),
        progress(folder / "progress.txt"),
        plan(folder / "plan.json"),
        verification(folder / "verification.json") {}
  std::filesystem::path request;
  std::filesystem::path result;    ///< absent when the trial did not end by itself
  std::filesystem::path progress;  ///< a line "seconds removed" per step
  std::filesystem::path plan;      ///< saved while it grows
  std::filesystem::path verification;
};

/// Exit status of a trial whose memory was not enough: it ends at the first request that is refused.
inline constexpr int kOutOfMemory = 86;

DISMANTLE_API void write_request(const TrialRequest& request, const std::filesystem::path& folder);

/// Plans what `folder` asks for. @throws ConfigError, InputError, PluginError as `dismantle plan` does.
DISMANTLE_API void plan_trial(const std::filesystem::path& folder);
/// Checks the plan in `folder` with the verifier, in a process that no planner was loaded into.
DISMANTLE_API void verify_trial(const std::filesystem::path& folder);

}  // namespace dismantle::bench
