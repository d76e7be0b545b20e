// Results::enlist(): the rows of a suite, compared with those that are there.
#include <fmt/format.h>

#include <algorithm>

#include "dismantle/errors.h"
#include "store/identity.h"
#include "store/results.h"
#include "store/suite_tables.h"
#include "store/version.h"

namespace dismantle::bench {
namespace {

void put(Sqlite& db, const std::string& key, const std::string& value) {
  db.prepare("INSERT OR REPLACE INTO suite VALUES (?, ?)").bind(key).bind(value).done();
}

std::string plan_columns() {
  std::string names;
  for_plan_columns(TrialPlan{}, [&](const char* name, const auto&, const char*) {
    names += (names.empty() ? "" : ", ") + std::string(name);
  });
  return names;
}

}  // namespace

void Results::add_configs(const std::vector<ConfigRecord>& configs) {
  auto add_config = db_.prepare("INSERT OR IGNORE INTO configs VALUES (?, ?)");
  auto add_plugin = db_.prepare("INSERT OR IGNORE INTO plugins VALUES (?, ?, ?, ?, ?, ?, ?)");
  for (const auto& config : configs) {
    add_config.bind(config.hash).bind(config.text).done();
    for (const auto& p : config.plugins)
      add_plugin.bind(config.hash)
          .bind(p.section)
          .bind(p.type)
          .bind(p.plugin)
          .bind(p.version)
          .bind(p.file)
          .bind(p.sha256)
          .done();
  }
}

std::set<std::string> Results::changed_inputs(const std::map<std::string, std::string>& inputs) {
  std::set<std::string> out;
  auto read = db_.prepare("SELECT value FROM suite WHERE key = ?");
  for (const auto& [assembly, hash] : inputs) {
    read.bind("input:" + assembly);
    if (read.step() && read.text(0) != hash) out.insert(assembly);
    read.done();
  }
  return out;
}

std::pair<std::int64_t, TrialPlan> Results::known_row(const TrialPlan& t) {
  auto find = db_.prepare(fmt::format(
      "SELECT id, {} FROM trials WHERE assembly = ? AND variant = ? AND planner = ? AND seed = ?", plan_columns()));
  find.bind(t.assembly).bind(t.variant).bind(t.planner).bind(t.seed);
  TrialPlan known;
  if (!find.step()) return {0, known};
  int column = 1;
  for_plan_columns(known, [&](const char*, auto& value, const char*) { find.get(column++, value); });
  return {find.integer(0), known};
}

std::string Results::difference(const TrialPlan& known, const TrialPlan& trial, bool input_changed) {
  if (input_changed) return "the input of the assembly";
  if (std::string shared = shared_difference(known, trial); !shared.empty()) return shared;
  if (known.planner_hash == trial.planner_hash) return {};
  std::string texts[2];
  auto read = db_.prepare("SELECT text FROM configs WHERE hash = ?");
  for (int i = 0; i < 2; ++i) {
    read.bind(i == 0 ? known.config_hash : trial.config_hash);
    if (read.step()) texts[i] = read.text(0);
    read.done();
  }
  const std::string values = changed_values(texts[0], texts[1]);
  return "its configuration or a plugin file" + (values.empty() ? "" : " (" + values + ")");
}

void Results::reset(std::int64_t id, const TrialPlan& trial) {
  for (const char* table : {"plans", "progress", "searches", "search_nodes"})
    db_.prepare(fmt::format("DELETE FROM {} WHERE trial = ?", table)).bind(id).done();
  std::string columns;
  for_result_columns(TrialResult{},
                     [&](const char* name, const auto&, const char*) { columns += fmt::format(", {} = NULL", name); });
  for_plan_columns(trial,
                   [&](const char* name, const auto&, const char*) { columns += fmt::format(", {} = ?", name); });
  auto update = db_.prepare(fmt::format(
      "UPDATE trials SET state = 'waiting', owner = NULL, owner_host = NULL, lease_until = NULL{} WHERE id = ?",
      columns));
  for_plan_columns(trial, [&](const char*, const auto& value, const char*) { update.bind(value); });
  update.bind(id).done();
}

std::vector<std::string> Results::enlist(const Suite& suite, const Wanted& wanted) {
  Transaction transaction(db_);
  add_configs(wanted.configs);
  const std::set<std::string> changed = changed_inputs(wanted.inputs);
  std::string marks;
  for_plan_columns(TrialPlan{}, [&](const char*, const auto&, const char*) { marks += marks.empty() ? "?" : ", ?"; });
  auto add = db_.prepare(fmt::format("INSERT OR IGNORE INTO trials ({}) VALUES ({})", plan_columns(), marks));
  auto want = db_.prepare("INSERT INTO wanted VALUES (?, ?)");
  std::map<std::pair<std::string, std::string>, std::size_t> again;  // planner, why: rows
  for (std::size_t i = 0; i < wanted.trials.size(); ++i) {
    const TrialPlan& t = wanted.trials[i];
    for_plan_columns(t, [&](const char*, const auto& value, const char*) { add.bind(value); });
    add.done();
    const bool is_new = db_.changes() > 0;
    const auto [id, known] = known_row(t);
    if (const std::string differs = is_new ? "" : difference(known, t, changed.contains(t.assembly));
        !differs.empty()) {
      if (!wanted.replace)
        throw Error(
            fmt::format("{}: planner '{}' on '{}' (seed {}) has a row already that was made with something else: "
                        "{} differs. Rows are not mixed: --replace runs such rows again; or use another folder (-o)",
                        db_.name(), t.planner, t.assembly, t.seed, differs));
      reset(id, t);
      ++again[{t.planner, differs}];
    }
    ids_.push_back(id);
    want.bind(static_cast<std::int64_t>(i)).bind(id).done();
  }
  for (const TrialPlan& t : wanted.others) {
    const auto [id, known] = known_row(t);
    if (id == 0) continue;
    const std::string differs =
        changed.contains(t.assembly) ? "the input of the assembly" : shared_difference(known, t);
    if (!differs.empty())
      throw Error(
          fmt::format("{}: {} differs from that of the rows of planner '{}' on '{}', which --only does not name: "
                      "planners would not be comparable. Without --only, --replace runs them again, too",
                      db_.name(), differs, t.planner, t.assembly));
  }
  put(db_, "name", suite.name);
  put(db_, "text", suite.text);
  put(db_, "tables", text_of(suite.tables));
  put(db_, "generator", "dismantle " + version_and_commit());
  std::string planners, variants;
  for (const auto& planner : suite.planners) planners += planner.name + "\n";
  for (const auto& variant : suite.variants) variants += variant.name + "\n";
  put(db_, "planners", planners);
  put(db_, "variants", variants);
  for (const auto& [assembly, hash] : wanted.inputs) put(db_, "input:" + assembly, hash);
  transaction.commit();
  std::vector<std::string> notes;
  for (const auto& [what, rows] : again)
    notes.push_back(fmt::format("planner '{}': {} row{} {} run again: {} differs", what.first, rows,
                                rows == 1 ? "" : "s", rows == 1 ? "is" : "are", what.second));
  return notes;
}

}  // namespace dismantle::bench
