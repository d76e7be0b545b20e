/// Runs a suite as a job array on an existing Slurm cluster: each task is a shard with its own database.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dismantle/export.h"

namespace dismantle::bench {

struct SlurmJob {
  std::filesystem::path suite, folder, program;
  unsigned tasks = 1;                  ///< in the array
  unsigned jobs = 1;                   ///< concurrent trials of each task; also its number of cores
  std::vector<std::string> options;    ///< for sbatch, such as --partition=cpu
  std::vector<std::string> arguments;  ///< more arguments of `dismantle bench`
};

struct Submitted {
  std::filesystem::path script;
  std::string id;
};

/// The batch script. Paths in it are absolute. $DISMANTLE_PLUGIN_PATH and $DISMANTLE_DATA are written into it.
DISMANTLE_API std::string slurm_script(const SlurmJob& job);

/// Writes `folder`/slurm.sh and submits it. @throws Error when there is no sbatch, or with the message of sbatch.
DISMANTLE_API Submitted submit(const SlurmJob& job);

}  // namespace dismantle::bench
