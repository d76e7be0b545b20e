#include "store/sqlite.h"

#include <fmt/format.h>

#include "dismantle/errors.h"

namespace dismantle::bench {
namespace {

constexpr int kPatience = 60'000, kPause = 10;  // ms to wait for another writer, and between two tries

}  // namespace

Sqlite::Sqlite(const std::filesystem::path& file, Mode mode) : name_(file.string()) {
  const int flags = mode == Mode::read ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  const int status = sqlite3_open_v2(name_.c_str(), &db_, flags, nullptr);
  if (status != SQLITE_OK) {
    const std::string why = db_ != nullptr ? sqlite3_errmsg(db_) : sqlite3_errstr(status);
    sqlite3_close(db_);
    throw InputError(name_, "cannot be opened as a database: " + why);
  }
  sqlite3_busy_timeout(db_, kPatience);
  // A database may come from an untrusted source: its schema must not call functions with side effects, nor write to
  // internal tables.
  sqlite3_db_config(db_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(db_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_limit(db_, SQLITE_LIMIT_LENGTH, 256 << 20);  // bytes per value; plans are far smaller
}

Sqlite::~Sqlite() { sqlite3_close(db_); }

void Sqlite::fail(const std::string& doing) const {
  throw InputError(name_, fmt::format("{}: {}", doing, sqlite3_errmsg(db_)));
}

void Sqlite::run(const std::string& sql) {
  if (sqlite3_exec(db_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail("the database refuses");
}

void Sqlite::write_ahead() {
  for (int waited = 0;; waited += kPause) {
    const int status = sqlite3_exec(db_, "PRAGMA journal_mode = WAL", nullptr, nullptr, nullptr);
    if (status == SQLITE_OK) return;
    if (status != SQLITE_BUSY || waited >= kPatience) fail("the database refuses");
    sqlite3_sleep(kPause);
  }
}

Statement Sqlite::prepare(const std::string& sql) { return Statement(*this, sql); }

Statement::Statement(Sqlite& db, const std::string& sql) : db_(db) {
  check(sqlite3_prepare_v2(db.handle(), sql.c_str(), -1, &statement_, nullptr), "is not a database of results");
}

Statement::~Statement() { sqlite3_finalize(statement_); }

void Statement::check(int status, const char* doing) {
  if (status != SQLITE_OK) db_.fail(doing);
}

Statement& Statement::bind(std::int64_t value) {
  check(sqlite3_bind_int64(statement_, next_++, value), "binding");
  return *this;
}
Statement& Statement::bind(double value) {
  check(sqlite3_bind_double(statement_, next_++, value), "binding");
  return *this;
}
Statement& Statement::bind(std::string_view text) {
  check(sqlite3_bind_text64(statement_, next_++, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8), "binding");
  return *this;
}
Statement& Statement::blob(std::string_view bytes) {
  check(sqlite3_bind_blob64(statement_, next_++, bytes.data(), bytes.size(), SQLITE_TRANSIENT), "binding");
  return *this;
}
Statement& Statement::null() {
  check(sqlite3_bind_null(statement_, next_++), "binding");
  return *this;
}

bool Statement::step() {
  const int status = sqlite3_step(statement_);
  if (status == SQLITE_ROW) return true;
  if (status != SQLITE_DONE) db_.fail("reading or writing");
  return false;
}

void Statement::done() {
  while (step()) {
  }
  check(sqlite3_reset(statement_), "writing");
  next_ = 1;
}

std::string Statement::text(int column) const {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_, column));
  return bytes == nullptr ? std::string()
                          : std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)));
}
int Statement::column(std::string_view name) const {
  for (int i = 0; i < sqlite3_column_count(statement_); ++i)
    if (name == sqlite3_column_name(statement_, i)) return i;
  return -1;
}

Transaction::~Transaction() {
  // The exception in flight states the error, so that of ROLLBACK is ignored. SQLite then rolls back by itself.
  if (open_) sqlite3_exec(db_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
  db_.run("COMMIT");
  open_ = false;
}

}  // namespace dismantle::bench
