#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "dismantle/bench/report.h"
#include "dismantle/errors.h"
#include "dismantle/plan/plan.h"
#include "store/compress.h"
#include "store/sqlite.h"

namespace dismantle::bench {
namespace {

/// Every column of the row.
nlohmann::ordered_json json_of(Sqlite& db, std::int64_t id) {
  sqlite3_stmt* statement = nullptr;
  nlohmann::ordered_json out;
  if (sqlite3_prepare_v2(db.handle(), "SELECT * FROM trials WHERE id = ?", -1, &statement, nullptr) != SQLITE_OK)
    db.fail("is not a database of results");
  sqlite3_bind_int64(statement, 1, id);
  if (sqlite3_step(statement) == SQLITE_ROW)
    for (int i = 0; i < sqlite3_column_count(statement); ++i) {
      auto& value = out[sqlite3_column_name(statement, i)];
      switch (sqlite3_column_type(statement, i)) {
        case SQLITE_INTEGER:
          value = sqlite3_column_int64(statement, i);
          break;
        case SQLITE_FLOAT:
          value = sqlite3_column_double(statement, i);
          break;
        case SQLITE_NULL:
          break;
        default:
          value = reinterpret_cast<const char*>(sqlite3_column_text(statement, i));
      }
    }
  sqlite3_finalize(statement);
  return out;
}

}  // namespace

std::string write_row(const ReportRow& row, const std::filesystem::path& folder) {
  Sqlite db(row.database, Sqlite::Mode::read);
  auto config = db.prepare("SELECT text FROM configs WHERE hash = ?");
  config.bind(row.config_hash);
  if (!config.step()) throw InputError(row.database.string(), fmt::format("row {} has no configuration", row.id));
  write_file(folder / "config.yaml", config.text(0));
  auto plan = db.prepare("SELECT size, bytes FROM plans WHERE trial = ?");
  plan.bind(row.id);
  if (plan.step()) write_file(folder / "plan.json", expanded(plan.text(1), static_cast<std::size_t>(plan.integer(0))));
  const auto json = json_of(db, row.id);
  write_file(folder / "row.json", json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  return fmt::format("dismantle plan '{}' -c '{}'{}", row.input, (folder / "config.yaml").string(),
                     row.part.empty() ? "" : fmt::format(" --part '{}'", row.part));
}

}  // namespace dismantle::bench
