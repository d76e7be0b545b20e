#include "store/results.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <map>
#include <set>

#include "dismantle/errors.h"
#include "store/compress.h"
#include "store/owner.h"
#include "store/tables.h"
#include "store/version.h"

namespace dismantle::bench {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count(); }

void set(Sqlite& db, const std::string& key, const std::string& value) {
  db.prepare("INSERT OR REPLACE INTO suite VALUES (?, ?)").bind(key).bind(value).done();
}

template <class T>
constexpr const char* sql_type() {
  if constexpr (std::is_same_v<T, std::string>) return "TEXT";
  if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::optional<double>>) return "REAL";
  return "INTEGER";
}

std::string tables() {
  const ReportRow row;
  std::string planned, results;
  for_plan_columns(row, [&]<class T>(const char* name, const T&, const char*) {
    planned += fmt::format("{} {} NOT NULL, ", name, sql_type<T>());
  });
  for_result_columns(row, [&]<class T>(const char* name, const T&, const char*) {
    results += fmt::format("{} {}, ", name, sql_type<T>());
  });
  return fmt::format(kTables, planned, results);
}

/// Columns that rows of an older version lack are empty in them.
void add_columns(Sqlite& db) {
  std::set<std::string> there;
  {
    auto columns = db.prepare("SELECT name FROM pragma_table_info('trials')");
    while (columns.step()) there.insert(columns.text(0));
  }
  for_result_columns(ReportRow{}, [&]<class T>(const char* name, const T&, const char*) {
    if (!there.contains(name)) db.run(fmt::format("ALTER TABLE trials ADD COLUMN {} {}", name, sql_type<T>()));
  });
}

void check_version(Sqlite& db) {
  std::string held;
  {
    auto version = db.prepare("SELECT value FROM suite WHERE key = 'store_version'");
    if (version.step()) held = version.text(0);
  }
  if (held.empty()) return set(db, "store_version", std::to_string(kStoreVersion));
  if (held == std::to_string(kOldestVersion)) {
    add_columns(db);
    return set(db, "store_version", std::to_string(kStoreVersion));
  }
  if (held != std::to_string(kStoreVersion))
    throw InputError(db.name(),
                     fmt::format("holds results in version {}, this Dismantle writes version {}; use another "
                                 "folder",
                                 held, kStoreVersion));
}

}  // namespace

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

Results::Results(const std::filesystem::path& file)
    : db_(file, Sqlite::Mode::write), host_(this_host()), cpu_(cpu_model()), owner_(this_owner()) {
  db_.write_ahead();
  db_.run("PRAGMA synchronous = FULL");
  Transaction transaction(db_);
  db_.run(tables());
  check_version(db_);
  transaction.commit();
  db_.run("CREATE TEMP TABLE wanted (place INTEGER PRIMARY KEY, id INTEGER NOT NULL)");
}

std::optional<std::size_t> Results::next_waiting(std::size_t from) {
  auto next = db_.prepare(
      "SELECT w.place FROM wanted w CROSS JOIN trials t ON t.id = w.id WHERE w.place >= ? AND t.state = 'waiting' "
      "ORDER BY w.place LIMIT 1");
  next.bind(static_cast<std::int64_t>(from));
  return next.step() ? std::optional(static_cast<std::size_t>(next.integer(0))) : std::nullopt;
}

std::optional<std::size_t> Results::claim() {
  Transaction transaction(db_);
  {
    // Dead processes of this machine are detected immediately; those of other machines when their lease expires.
    auto orphans = db_.prepare(
        "SELECT DISTINCT owner, owner_host, max(lease_until) FROM trials WHERE state = 'running' "
        "GROUP BY owner, owner_host");
    std::vector<std::pair<std::string, std::string>> gone;
    while (orphans.step()) {
      const std::string owner = orphans.text(0), host = orphans.text(1);
      if (host == host_ ? !is_alive(owner) : orphans.number(2) < now()) gone.emplace_back(owner, host);
    }
    for (const auto& [owner, host] : gone)
      db_.prepare(
             "UPDATE trials SET state = 'waiting', owner = NULL, owner_host = NULL, lease_until = NULL "
             "WHERE state = 'running' AND owner = ? AND owner_host = ?")
          .bind(owner)
          .bind(host)
          .done();
  }
  // Trials are claimed in order. Earlier ones are considered again only when no later one waits.
  std::optional<std::size_t> place = next_waiting(next_);
  if (!place && next_ > 0) place = next_waiting(0);
  if (place)
    db_.prepare("UPDATE trials SET state = 'running', owner = ?, owner_host = ?, lease_until = ? WHERE id = ?")
        .bind(owner_)
        .bind(host_)
        .bind(now() + std::chrono::duration<double>(kLease).count())
        .bind(ids_.at(*place))
        .done();
  transaction.commit();
  next_ = place ? *place + 1 : 0;
  return place;
}

void Results::renew(std::size_t trial) {
  db_.prepare("UPDATE trials SET lease_until = ? WHERE id = ? AND state = 'running' AND owner = ?")
      .bind(now() + std::chrono::duration<double>(kLease).count())
      .bind(ids_.at(trial))
      .bind(owner_)
      .done();
}

void Results::release(std::size_t trial) {
  db_.prepare(
         "UPDATE trials SET state = 'waiting', owner = NULL, owner_host = NULL, lease_until = NULL WHERE id = ? AND "
         "state = 'running' AND owner = ?")
      .bind(ids_.at(trial))
      .bind(owner_)
      .done();
}

void Results::finish(std::size_t trial, TrialRecord record) {
  const std::int64_t id = ids_.at(trial);
  TrialResult& result = record.result;
  result.host = host_.substr(0, host_.find(' '));
  result.cpu_model = cpu_;
  result.version = version_and_commit();
  result.ended = utc_now();
  std::string columns;
  for_result_columns(result,
                     [&](const char* name, const auto&, const char*) { columns += fmt::format(", {} = ?", name); });
  Transaction transaction(db_);
  auto update = db_.prepare(fmt::format(
      "UPDATE trials SET state = 'done', owner = NULL, owner_host = NULL, lease_until = NULL{} WHERE id = ? AND "
      "state = 'running' AND owner = ?",
      columns));
  for_result_columns(result, [&](const char*, const auto& value, const char*) { update.bind(value); });
  update.bind(id).bind(owner_).done();
  if (db_.changes() == 0) return;  // the lease expired: another machine has claimed the trial, and its row counts
  if (!record.plan.empty())
    db_.prepare("INSERT INTO plans VALUES (?, 'zlib', ?, ?)")
        .bind(id)
        .bind(static_cast<std::int64_t>(record.plan.size()))
        .blob(compressed(record.plan))
        .done();
  auto add = db_.prepare("INSERT INTO progress VALUES (?, ?, ?)");
  for (const auto& [seconds, removed] : record.progress) add.bind(id).bind(seconds).bind(removed).done();
  auto point = db_.prepare("INSERT INTO searches VALUES (?, ?, ?, ?, ?, ?)");
  for (const SearchPoint& p : record.searches.points)
    point.bind(id).bind(p.search).bind(p.part).bind(p.seconds).bind(p.effort).bind(p.best).done();
  auto node = db_.prepare("INSERT INTO search_nodes VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const SearchNode& n : record.searches.nodes) {
    node.bind(id).bind(n.search).bind(n.node).bind(n.parent).bind(n.effort);
    for (const double x : n.place) node.bind(x);
    node.done();
  }
  transaction.commit();
}

Tally Results::tally() {
  Tally out;
  auto read = db_.prepare(
      "SELECT planner, count(*), sum(state = 'done'), sum(coalesce(solved, 0)), sum(coalesce(wall_seconds, 0)) "
      "FROM wanted w CROSS JOIN trials t ON t.id = w.id GROUP BY planner ORDER BY min(w.place)");
  while (read.step()) {
    out.total += read.integer(1);
    out.done += read.integer(2);
    out.seconds += read.number(4);
    out.planners.push_back({read.text(0), {read.integer(3), read.integer(2)}});
  }
  return out;
}

}  // namespace dismantle::bench
