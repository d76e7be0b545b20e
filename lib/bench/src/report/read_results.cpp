#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "dismantle/bench/report.h"
#include "dismantle/errors.h"
#include "dismantle/preparation/read_input.h"
#include "report/observations.h"
#include "store/results.h"
#include "store/suite_tables.h"

namespace dismantle::bench {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> databases_in(const std::vector<fs::path>& paths) {
  std::vector<fs::path> out;
  for (const auto& path : paths) {
    std::error_code error;
    if (!fs::exists(path, error)) throw InputError(path.string(), "does not exist");
    if (!fs::is_directory(path, error)) {
      out.push_back(path);
      continue;
    }
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(path))
      if (entry.path().extension() == ".db") found.push_back(entry.path());
    if (found.empty()) throw InputError(path.string(), "holds no results (*.db); `dismantle bench` writes them");
    std::sort(found.begin(), found.end(),
              [](const fs::path& a, const fs::path& b) { return natural_less(a.string(), b.string()); });
    out.insert(out.end(), found.begin(), found.end());
  }
  return out;
}

void append_new(std::vector<std::string>& list, const std::string& lines) {
  for (std::size_t begin = 0; begin < lines.size();) {
    const std::size_t end = std::min(lines.find('\n', begin), lines.size());
    const std::string word = lines.substr(begin, end - begin);
    if (std::find(list.begin(), list.end(), word) == list.end()) list.push_back(word);
    begin = end + 1;
  }
}

/// `columns`: where each column of a row is, in the order of for_columns(); -1: not in this database.
ReportRow row_of(const Statement& s, const std::vector<int>& columns, const fs::path& database) {
  ReportRow r;
  r.database = database;
  s.get(0, r.id);
  s.get(1, r.has_plan);
  auto column = columns.begin();
  for_columns(r, [&](const char*, auto& value, const char*) {
    if (const int at = *column++; at >= 0) s.get(at, value);
  });
  r.stops_at = r.limit_timeout;
  return r;
}

std::vector<PluginUse> plugins_of(Sqlite& db, const std::string& config) {
  auto read = db.prepare(
      "SELECT section, type, plugin, version, file, sha256 FROM plugins WHERE config_hash = ? ORDER BY section");
  read.bind(config);
  std::vector<PluginUse> out;
  while (read.step())
    out.push_back({read.text(0), read.text(1), read.text(2), read.text(3), read.text(4), read.text(5)});
  return out;
}

class Merger {
 public:
  void add(const fs::path& file) {
    Sqlite db(file, Sqlite::Mode::read);
    const auto value = [&](const char* key) {
      auto read = db.prepare("SELECT value FROM suite WHERE key = ?");
      read.bind(key);
      return read.step() ? read.text(0) : std::string();
    };
    if (const std::string held = value("store_version");
        held != std::to_string(kStoreVersion) && held != std::to_string(kOldestVersion))
      throw InputError(file.string(),
                       fmt::format("holds results in version '{}', this Dismantle reads versions {} to {}", held,
                                   kOldestVersion, kStoreVersion));
    append_new(names_, value("name"));
    append_new(data_.planners, value("planners"));
    for (SuiteTable& table : suite_tables_of(value("tables")))
      if (std::ranges::none_of(data_.tables, [&](const SuiteTable& t) { return t.id == table.id; }))
        data_.tables.push_back(std::move(table));
    const bool has_searches = db.prepare("SELECT 1 FROM sqlite_master WHERE name = 'searches'").step();
    std::optional<Statement> searches;
    if (has_searches)
      searches.emplace(db, "SELECT search, part, seconds, effort, best FROM searches WHERE trial = ? ORDER BY rowid");
    append_new(data_.variants, value("variants"));
    auto open = db.prepare("SELECT count(*) FROM trials WHERE state <> 'done'");
    if (open.step()) data_.missing += static_cast<std::size_t>(open.integer(0));
    auto read =
        db.prepare("SELECT id, id IN (SELECT trial FROM plans), * FROM trials WHERE state = 'done' ORDER BY id");
    std::vector<int> columns;
    for_columns(ReportRow{}, [&](const char* name, const auto&, const char*) { columns.push_back(read.column(name)); });
    auto progress = db.prepare("SELECT seconds, removed FROM progress WHERE trial = ? ORDER BY seconds, removed");
    while (read.step()) {
      ReportRow row = row_of(read, columns, file);
      check_same_planner(row);
      if (!seen_.insert({row.assembly, row.variant, row.planner, row.seed}).second) {
        ++twice_;
        continue;
      }
      progress.bind(row.id);
      while (progress.step()) row.progress.emplace_back(progress.number(0), progress.integer(1));
      progress.done();
      if (searches) {
        searches->bind(row.id);
        while (searches->step())
          row.searches.push_back(
              {searches->integer(0), searches->number(2), searches->number(3), searches->number(4), searches->text(1)});
        searches->done();
      }
      if (!data_.composition.contains(row.planner)) data_.composition[row.planner] = plugins_of(db, row.config_hash);
      append_new(data_.planners, row.planner);  // for rows of planners that are no longer in the suite
      append_new(data_.variants, row.variant);
      data_.rows.push_back(std::move(row));
    }
  }

  ReportData take() {
    for (const auto& name : names_) data_.name += (data_.name.empty() ? "" : ", ") + name;
    fill_parts();
    sort();
    number_observations(data_.rows);
    if (data_.missing > 0)
      data_.notes.push_back(fmt::format("{} trials are not done yet and not counted.", data_.missing));
    if (twice_ > 0)
      data_.notes.push_back(fmt::format("{} rows were in several databases; the first of each was taken.", twice_));
    note_inputs();
    note_versions();
    return std::move(data_);
  }

 private:
  void check_same_planner(const ReportRow& row) {
    const auto [known, is_new] = planners_.try_emplace(row.planner, row.planner_hash, row.database);
    if (is_new || known->second.first == row.planner_hash) return;
    throw InputError(row.database.string(),
                     fmt::format("planner '{}' has another configuration or another plugin file than in {}; rows of "
                                 "different planners are not merged under one name",
                                 row.planner, known->second.second.string()));
  }

  /// A trial that crashed early has no number of parts; it is taken from other trials of the same assembly.
  void fill_parts() {
    std::map<std::string, std::int64_t> parts;
    std::set<std::string> differ;
    for (const auto& row : data_.rows) {
      if (!row.parts) continue;
      auto& most = parts[row.assembly];
      if (most != 0 && most != *row.parts) differ.insert(row.assembly);
      most = std::max(most, *row.parts);
    }
    for (auto& row : data_.rows)
      if (const auto known = parts.find(row.assembly); !row.parts && known != parts.end()) row.parts = known->second;
    if (!differ.empty())
      data_.notes.push_back(fmt::format(
          "Planners kept different numbers of parts of: {}. Their rows are not comparable.", fmt::join(differ, ", ")));
  }

  void sort() {
    const auto rank = [](const std::vector<std::string>& list, const std::string& name) {
      return std::find(list.begin(), list.end(), name) - list.begin();
    };
    std::sort(data_.rows.begin(), data_.rows.end(), [&](const ReportRow& a, const ReportRow& b) {
      if (a.assembly != b.assembly) return natural_less(a.assembly, b.assembly);
      return std::make_tuple(rank(data_.variants, a.variant), rank(data_.planners, a.planner), a.seed) <
             std::make_tuple(rank(data_.variants, b.variant), rank(data_.planners, b.planner), b.seed);
    });
  }

  void note_inputs() {
    std::map<std::tuple<std::string, std::string, std::int64_t>, std::string> inputs;
    std::set<std::string> differ;
    for (const auto& row : data_.rows) {
      if (row.input_sha256.empty()) continue;  // it ended before it was read
      const auto known = inputs.try_emplace({row.assembly, row.variant, row.seed}, row.input_sha256).first;
      if (known->second != row.input_sha256) differ.insert(row.assembly);
    }
    if (!differ.empty())
      data_.notes.push_back(
          fmt::format("Rows are of different files of: {}. They are not comparable.", fmt::join(differ, ", ")));
  }

  void note_versions() {
    std::set<std::string> hosts, versions;
    for (const auto& row : data_.rows) {
      hosts.insert(row.host);
      versions.insert(row.version);
    }
    if (hosts.size() > 1) data_.notes.push_back(fmt::format("Times are from {} machines.", hosts.size()));
    if (versions.size() > 1)
      data_.notes.push_back(fmt::format("Rows are from several versions of Dismantle: {}.", fmt::join(versions, ", ")));
  }

  ReportData data_;
  std::vector<std::string> names_;
  std::set<std::tuple<std::string, std::string, std::string, std::int64_t>> seen_;
  std::map<std::string, std::pair<std::string, fs::path>> planners_;
  std::size_t twice_ = 0;
};

}  // namespace

ReportData read_results(const std::vector<fs::path>& paths) {
  Merger merger;
  for (const auto& file : databases_in(paths)) merger.add(file);
  return merger.take();
}

}  // namespace dismantle::bench
