/// The database of a suite: one row per trial, claimed by the process that runs it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/bench/suite.h"
#include "store/sqlite.h"

namespace dismantle::bench {

/// What makes a row a row; no two rows of a database have the same.
struct TrialKey {
  std::string assembly, variant, planner;
  std::int64_t seed = 0;
};

/// What is known before a trial runs.
struct TrialPlan {
  TrialKey key;
  std::string category, part;
  std::string planner_hash;  ///< of the configuration without seed and folders: a row of another one is not reused
  std::string config_hash;   ///< of the configuration that is run
};

struct PluginUse {
  std::string section, type, plugin, version, file, sha256;
};

struct ConfigRecord {
  std::string hash, text;
  std::vector<PluginUse> plugins;
};

/// Everything that a trial leaves behind. Empty optionals: not known, because the trial did not come that far.
struct TrialRow {
  std::string outcome;  ///< docs/benchmark.md
  bool solved = false;  ///< the planner says so and the verifier agrees
  std::optional<bool> verified, complete;
  std::optional<double> max_penetration;
  std::string verification;  ///< what the verifier objects to, or why there is no verification
  std::int64_t signal = 0, exit_status = 0;
  std::string last_words;
  std::string input, input_sha256;
  std::optional<std::int64_t> parts, excluded, removed, left, steps;
  double wall_seconds = 0, cpu_seconds = 0, peak_rss_mb = 0;
  std::optional<double> load_seconds, prepare_seconds, plan_seconds, solve_seconds, proof_seconds, verify_seconds;
  std::optional<std::int64_t> attempts, memoised;
  std::optional<double> simulated_steps, nodes, collision_checks;
  std::string counts;  ///< all counts of the planner, JSON
  std::string started;
  std::string plan;                                       ///< JSON text; empty: there is none
  std::vector<std::pair<double, std::int64_t>> progress;  ///< seconds, parts out
};

struct Tally {
  std::int64_t done = 0, total = 0;
  double seconds = 0;                                                                   ///< wall time of those done
  std::vector<std::pair<std::string, std::pair<std::int64_t, std::int64_t>>> planners;  ///< name, (solved, done)
};

/// A suite's results, open for running. Several processes may have it open simultaneously.
class Results {
 public:
  /// @throws InputError when the file is no database of this version.
  explicit Results(const std::filesystem::path& file);

  /// Adds what is missing of the suite, and remembers what this process is to run.
  /// @throws Error when a row that is there was made with another configuration.
  void enlist(const Suite& suite, const std::vector<TrialPlan>& trials, const std::vector<ConfigRecord>& configs);
  /// Claims a trial that no process runs: its index into what was enlisted. Nothing when there is none.
  std::optional<std::size_t> claim();
  /// Other processes on other machines take a trial over when its owner has not been heard of for a while.
  void renew(std::size_t trial);
  /// Puts a claimed trial back.
  void release(std::size_t trial);
  /// The row, its plan and its progress, in one transaction.
  void finish(std::size_t trial, const TrialRow& row);
  /// Of what this process was enlisted for.
  Tally tally();

 private:
  /// The first of the enlisted trials, from `from` on, that waits.
  std::optional<std::size_t> next_waiting(std::size_t from);
  Sqlite db_;
  std::string host_, cpu_, owner_;
  std::vector<std::int64_t> ids_;
  std::size_t next_ = 0;
};

/// Without a sign of life for this long, a trial of another machine is taken over.
inline constexpr std::chrono::seconds kLease{120};

/// Version of the tables.
inline constexpr int kStoreVersion = 2;

}  // namespace dismantle::bench
