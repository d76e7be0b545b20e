#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "dismantle/bench/report.h"
#include "dismantle/errors.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/write_file.h"
#include "launch/shell.h"
#include "report/search_trees.h"
#include "report/stored_plans.h"
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

}  // namespace

std::vector<std::string> write_plans(const ReportData& data, const std::filesystem::path& folder) {
  StoredPlans stored;
  std::vector<std::string> links(data.rows.size());
  for (std::size_t i = 0; i < data.rows.size(); ++i) {
    const ReportRow& row = data.rows[i];
    if (!row.has_plan) continue;
    const std::string name = fmt::format("{}.json", i + 1);
    write_file(folder / name, stored.of(row));
    links[i] = folder.filename().string() + "/" + name;
  }
  return links;
}

std::string write_row(const ReportRow& row, const std::filesystem::path& folder) {
  Sqlite db(row.database, Sqlite::Mode::read);
  auto config = db.prepare("SELECT text FROM configs WHERE hash = ?");
  config.bind(row.config_hash);
  if (!config.step()) throw InputError(row.database.string(), fmt::format("row {} has no configuration", row.id));
  write_file(folder / "config.yaml", config.text(0));
  if (row.has_plan) write_file(folder / "plan.json", StoredPlans().of(row));
  write_file(folder / "row.json", json_of(row).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  write_search_trees(db, row.id, folder);
  return fmt::format("dismantle plan {} -c {}{}", shell_quoted(row.input),
                     shell_quoted((folder / "config.yaml").string()),
                     row.part.empty() ? "" : " --part " + shell_quoted(row.part));
}

}  // namespace dismantle::bench
