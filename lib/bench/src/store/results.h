/// The database of a suite: one row per trial, claimed by the process that runs it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/bench/suite.h"
#include "dismantle/bench/trial_row.h"
#include "store/sqlite.h"

namespace dismantle::bench {

struct ConfigRecord {
  std::string hash, text;
  std::vector<PluginUse> plugins;
};

/// What a trial leaves for the database.
struct TrialRecord {
  TrialResult result;
  std::string plan;                                       ///< JSON text; empty: there is none
  std::vector<std::pair<double, std::int64_t>> progress;  ///< seconds, parts removed
};

struct Tally {
  std::int64_t done = 0, total = 0;
  double seconds = 0;  ///< wall time of the finished trials
  std::vector<std::pair<std::string, std::pair<std::int64_t, std::int64_t>>> planners;  ///< name, (solved, done)
};

/// Now, as in the columns `started` and `ended`.
std::string utc_now();

/// A suite's results, open for writing. Several processes may have them open simultaneously.
class Results {
 public:
  /// @throws InputError when the file is not a database of this version.
  explicit Results(const std::filesystem::path& file);

  /// Adds the missing rows of the suite. `trials`: those that this process may claim.
  /// @throws Error when an existing row was made with another configuration.
  void enlist(const Suite& suite, const std::vector<TrialPlan>& trials, const std::vector<ConfigRecord>& configs);
  /// Claims a trial that no process runs. Returns its index into the enlisted trials; nothing when there is none.
  std::optional<std::size_t> claim();
  /// Extends the lease of a claimed trial. Processes on other machines take over trials whose lease has expired.
  void renew(std::size_t trial);
  /// Releases a claimed trial, so that it waits again.
  void release(std::size_t trial);
  /// Writes the result, the plan and the progress of a trial in one transaction.
  void finish(std::size_t trial, TrialRecord record);
  /// Counts the trials that were enlisted.
  Tally tally();

 private:
  /// The first waiting trial among the enlisted ones, from index `from` on.
  std::optional<std::size_t> next_waiting(std::size_t from);
  Sqlite db_;
  std::string host_, cpu_, owner_;
  std::vector<std::int64_t> ids_;
  std::size_t next_ = 0;
};

/// A trial of another machine is taken over when its lease has not been renewed for this long.
inline constexpr std::chrono::seconds kLease{120};

/// Version of the database schema.
inline constexpr int kStoreVersion = 2;

}  // namespace dismantle::bench
