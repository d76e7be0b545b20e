/// The database of a suite: one row per trial, claimed by the process that runs it.
#pragma once

#include <map>
#include <optional>
#include <set>
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

/// What a process wants of a database.
struct Wanted {
  std::vector<TrialPlan> trials;  ///< that this process may claim
  std::vector<TrialPlan> others;  ///< their rows stay as they are, and have to be comparable
  std::vector<ConfigRecord> configs;
  std::map<std::string, std::string> inputs;  ///< hash of what each assembly is made from, by its name
  bool replace = false;                       ///< rows of `trials` that were made with something else are run again
};

/// What a trial leaves for the database.
struct TrialRecord {
  TrialResult result;
  std::string plan;                                       ///< JSON text; empty: there is none
  std::vector<std::pair<double, std::int64_t>> progress;  ///< seconds, parts removed
  SearchRecords searches;
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

  /// Adds the missing rows of the suite. Returns what is run again, and why.
  /// @throws Error when an existing row was made with something else, unless `replace` says to run it again.
  std::vector<std::string> enlist(const Suite& suite, const Wanted& wanted);
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
  void add_configs(const std::vector<ConfigRecord>& configs);
  /// Names of the assemblies whose input is another one than that of the rows.
  std::set<std::string> changed_inputs(const std::map<std::string, std::string>& inputs);
  /// The row of a trial, with its id; none: 0.
  std::pair<std::int64_t, TrialPlan> known_row(const TrialPlan& trial);
  /// Why a row is not one of `trial`; empty: it is.
  std::string difference(const TrialPlan& known, const TrialPlan& trial, bool input_changed);
  /// Empties a row, so that the trial waits with another identity.
  void reset(std::int64_t id, const TrialPlan& trial);
  Sqlite db_;
  std::string host_, cpu_, owner_;
  std::vector<std::int64_t> ids_;
  std::size_t next_ = 0;
};

/// A trial of another machine is taken over when its lease has not been renewed for this long.
inline constexpr std::chrono::seconds kLease{120};

/// Version of the database schema.
inline constexpr int kStoreVersion = 3;
/// That has the same tables with fewer columns: it is read, and completed where it is written to.
inline constexpr int kOldestVersion = 2;

}  // namespace dismantle::bench
