#include <fmt/format.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "dismantle/bench/report.h"
#include "dismantle/errors.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/write_file.h"
#include "launch/shell.h"
#include "store/compress.h"
#include "store/sqlite.h"

namespace dismantle::bench {
namespace {

nlohmann::ordered_json json_of(const ReportRow& row) {
  nlohmann::ordered_json out = {{"id", row.id}};
  for_columns(row, [&](const char* name, const auto& value, const char*) {
    if constexpr (requires { *value; })
      out[name] = value ? nlohmann::ordered_json(*value) : nullptr;
    else
      out[name] = value;
  });
  return out;
}

std::string plan_of(Sqlite& db, std::int64_t id) {
  auto plan = db.prepare("SELECT size, bytes FROM plans WHERE trial = ?");
  plan.bind(id);
  if (!plan.step()) throw InputError(db.name(), fmt::format("the plan of row {} is gone", id));
  return expanded(plan.text(1), static_cast<std::size_t>(plan.integer(0)));
}

}  // namespace

std::size_t write_plans(const ReportData& data, const std::filesystem::path& folder) {
  std::map<std::filesystem::path, std::unique_ptr<Sqlite>> open;
  std::size_t written = 0;
  for (std::size_t i = 0; i < data.rows.size(); ++i) {
    const ReportRow& row = data.rows[i];
    if (!row.has_plan) continue;
    auto& db = open[row.database];
    if (!db) db = std::make_unique<Sqlite>(row.database, Sqlite::Mode::read);
    write_file(folder / fmt::format("{}.json", i + 1), plan_of(*db, row.id));
    ++written;
  }
  return written;
}

std::string write_row(const ReportRow& row, const std::filesystem::path& folder) {
  Sqlite db(row.database, Sqlite::Mode::read);
  auto config = db.prepare("SELECT text FROM configs WHERE hash = ?");
  config.bind(row.config_hash);
  if (!config.step()) throw InputError(row.database.string(), fmt::format("row {} has no configuration", row.id));
  write_file(folder / "config.yaml", config.text(0));
  if (row.has_plan) write_file(folder / "plan.json", plan_of(db, row.id));
  write_file(folder / "row.json", json_of(row).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  return fmt::format("dismantle plan {} -c {}{}", shell_quoted(row.input),
                     shell_quoted((folder / "config.yaml").string()),
                     row.part.empty() ? "" : " --part " + shell_quoted(row.part));
}

}  // namespace dismantle::bench
