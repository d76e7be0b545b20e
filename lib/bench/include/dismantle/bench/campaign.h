/// Runs a suite: claims trials, runs each in separate processes and writes the rows.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "dismantle/bench/suite.h"
#include "dismantle/export.h"
#include "dismantle/run_context.h"

namespace dismantle::bench {

struct CampaignOptions {
  std::filesystem::path folder;             ///< results, inputs, configurations, running trials
  unsigned jobs = 1;                        ///< trials that run concurrently
  std::vector<std::string> only;            ///< planners whose trials are run; empty: all
  bool replace = false;                     ///< run rows again that were made with something else
  unsigned shard = 1, shards = 1;           ///< this is shard `shard` of `shards`, with its own database
  std::vector<std::string> plan_command;    ///< program and arguments; the folder of the trial is appended
  std::vector<std::string> verify_command;  ///< command that verifies a trial
};

struct CampaignResult {
  std::size_t total = 0, done = 0, solved = 0;  ///< in this shard, over all processes
  std::size_t ran = 0;                          ///< by this process
  std::vector<std::string> replaced;            ///< what is run again, and why
  bool interrupted = false;
  std::filesystem::path database;
};

/// The database of a shard: `results.db`, or `shard-I-of-N.db`.
DISMANTLE_API std::filesystem::path database_of(const CampaignOptions& options);

/// Runs the trials that have no row yet and waits for those that other processes run. When `context` is cancelled,
/// running trials are killed and released. Reports to `context.progress` and `context.log`.
/// @throws Error when the folder holds rows that were made with something else and `replace` is not set, when `only`
/// names no planner of the suite, or when the folder cannot be used.
DISMANTLE_API CampaignResult run_campaign(const Suite& suite, const CampaignOptions& options, RunContext& context);

/// Describes the matrix of trials and estimates how long it may take.
DISMANTLE_API std::string dry_run_text(const Suite& suite, const CampaignOptions& options);

/// "1 h 5 min", "12 s".
DISMANTLE_API std::string duration_text(double seconds);

}  // namespace dismantle::bench
