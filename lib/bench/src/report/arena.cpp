#include <fmt/format.h>

#include <map>

#include "dismantle/bench/report.h"
#include "dismantle/errors.h"
#include "store/sqlite.h"

namespace dismantle::bench {
namespace {

std::string config_of(std::map<std::filesystem::path, std::unique_ptr<Sqlite>>& open, const ReportRow& row) {
  auto& db = open[row.database];
  if (!db) db = std::make_unique<Sqlite>(row.database, Sqlite::Mode::read);
  auto read = db->prepare("SELECT text FROM configs WHERE hash = ?");
  read.bind(row.config_hash);
  if (!read.step()) throw InputError(row.database.string(), fmt::format("row {} has no configuration", row.id));
  return read.text(0);
}

class Arena {
 public:
  explicit Arena(Sqlite& db) : db_(db) {
    // The tables that `ompl_benchmark_statistics.py` writes and Planner Arena reads. `runs` has a column for each
    // property that any planner reports, named and typed as in OMPL's benchmark logs.
    db_.run(R"(
CREATE TABLE experiments (id INTEGER PRIMARY KEY ON CONFLICT REPLACE AUTOINCREMENT, name VARCHAR(512), totaltime REAL,
  timelimit REAL, memorylimit REAL, runcount INTEGER, version VARCHAR(128), hostname VARCHAR(1024), cpuinfo TEXT, date DATETIME,
  seed INTEGER, setup TEXT);
CREATE TABLE plannerConfigs (id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512) NOT NULL, settings TEXT);
CREATE TABLE enums (name VARCHAR(512), value INTEGER, description TEXT, PRIMARY KEY (name, value));
CREATE TABLE runs (id INTEGER PRIMARY KEY AUTOINCREMENT, experimentid INTEGER, plannerid INTEGER,
  time REAL, solved BOOLEAN, status ENUM, memory REAL, parts INTEGER, parts_out INTEGER, max_penetration REAL, cpu_time REAL,
  FOREIGN KEY (experimentid) REFERENCES experiments(id) ON DELETE CASCADE,
  FOREIGN KEY (plannerid) REFERENCES plannerConfigs(id) ON DELETE CASCADE);
CREATE TABLE progress (runid INTEGER, time REAL, parts_out INTEGER, PRIMARY KEY (runid, time),
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);
)");
  }

  void add(const ReportRow& row, const std::string& config) {
    const std::int64_t run = add_run(row, experiment_of(row), planner_of(row, config));
    auto add = db_.prepare("INSERT OR REPLACE INTO progress VALUES (?, ?, ?)");
    for (const auto& [seconds, out] : row.progress) add.bind(run).bind(seconds).bind(out).done();
  }

  void finish() {
    db_.run(
        "UPDATE experiments SET totaltime = (SELECT sum(time) FROM runs WHERE experimentid = experiments.id), "
        "runcount = (SELECT max(n) FROM (SELECT count(*) AS n FROM runs WHERE experimentid = experiments.id GROUP BY "
        "plannerid))");
  }

 private:
  /// An experiment of Planner Arena is one assembly in one variant.
  std::int64_t experiment_of(const ReportRow& row) {
    std::int64_t& id = experiments_[row.assembly + " " + row.variant];
    if (id != 0) return id;
    db_.prepare(
           "INSERT INTO experiments (name, timelimit, memorylimit, version, hostname, cpuinfo, date, seed, setup) "
           "VALUES "
           "(?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .bind(row.variant == "plain" ? row.assembly : row.assembly + " (" + row.variant + ")")
        .bind(row.limit_timeout > 0 ? row.limit_timeout : row.limit_wall)
        .bind(row.limit_memory_mb)
        .bind("dismantle " + row.version)
        .bind(row.host)
        .bind(row.cpu_model)
        .bind(row.ended)
        .bind(row.seed)
        .bind(row.part.empty() ? "whole assembly" : "part " + row.part)
        .done();
    return id = db_.last_id();
  }

  std::int64_t planner_of(const ReportRow& row, const std::string& config) {
    std::int64_t& id = planners_[row.planner];
    if (id != 0) return id;
    db_.prepare("INSERT INTO plannerConfigs (name, settings) VALUES (?, ?)").bind(row.planner).bind(config).done();
    return id = db_.last_id();
  }

  std::int64_t status_of(const std::string& outcome) {
    const auto [known, is_new] = outcomes_.try_emplace(outcome, static_cast<std::int64_t>(outcomes_.size()));
    if (is_new) db_.prepare("INSERT INTO enums VALUES ('status', ?, ?)").bind(known->second).bind(outcome).done();
    return known->second;
  }

  std::int64_t add_run(const ReportRow& row, std::int64_t experiment, std::int64_t planner) {
    db_.prepare(
           "INSERT INTO runs (experimentid, plannerid, time, solved, status, memory, parts, parts_out, "
           "max_penetration, "
           "cpu_time) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .bind(experiment)
        .bind(planner)
        .bind(row.solve_seconds.value_or(row.wall_seconds))
        .bind(row.solved)
        .bind(status_of(row.outcome))
        .bind(row.peak_rss_mb)
        .bind(row.parts)
        .bind(row.removed)
        .bind(row.max_penetration)
        .bind(row.cpu_seconds)
        .done();
    return db_.last_id();
  }

  Sqlite& db_;
  std::map<std::string, std::int64_t> experiments_, planners_, outcomes_;
};

}  // namespace

void write_arena(const ReportData& data, const std::filesystem::path& file) {
  std::filesystem::remove(file);
  Sqlite db(file, Sqlite::Mode::write);
  std::map<std::filesystem::path, std::unique_ptr<Sqlite>> open;
  Transaction transaction(db);
  Arena arena(db);
  for (const auto& row : data.rows) arena.add(row, config_of(open, row));
  arena.finish();
  transaction.commit();
}

}  // namespace dismantle::bench
