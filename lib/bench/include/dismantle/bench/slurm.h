/// A suite as a job array of an existing Slurm cluster: each task is a shard with a database of its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dismantle/export.h"

namespace dismantle::bench {

struct SlurmJob {
  std::filesystem::path suite, folder, program;
  unsigned tasks = 1;                ///< of the array
  unsigned jobs = 1;                 ///< concurrent trials of each task; its number of cores
  std::vector<std::string> options;  ///< for sbatch, such as --partition=cpu
};

struct Submitted {
  std::filesystem::path script;
  std::string id;
};

/// The batch script. Paths in it are absolute. $DISMANTLE_PLUGIN_PATH and $DISMANTLE_DATA are written into it.
DISMANTLE_API std::string slurm_script(const SlurmJob& job);

/// Writes `folder`/slurm.sh and submits it. @throws Error when there is no sbatch, or with what it says.
DISMANTLE_API Submitted submit(const SlurmJob& job);

}  // namespace dismantle::bench
