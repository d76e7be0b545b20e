/// Thin wrapper of SQLite that reports errors as exceptions.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace dismantle::bench {

class Statement;

/// One connection; used by one thread.
class Sqlite {
 public:
  enum class Mode { read, write };
  /// `write` creates the file if it does not exist. @throws InputError naming the file.
  Sqlite(const std::filesystem::path& file, Mode mode);
  ~Sqlite();
  Sqlite(const Sqlite&) = delete;
  Sqlite& operator=(const Sqlite&) = delete;

  /// One or several statements without results. @throws InputError.
  void run(const std::string& sql);
  /// Writers then do not keep readers waiting. SQLite ignores its timeout when several processes change the journal of a new
  /// database at once, so this waits by itself.
  void write_ahead();
  Statement prepare(const std::string& sql);
  std::int64_t changes() const { return sqlite3_changes(db_); }
  std::int64_t last_id() const { return sqlite3_last_insert_rowid(db_); }
  const std::string& name() const { return name_; }
  sqlite3* handle() const { return db_; }
  [[noreturn]] void fail(const std::string& doing) const;

 private:
  std::string name_;
  sqlite3* db_ = nullptr;
};

/// A prepared statement: bind values in the order of the question marks, then step.
class Statement {
 public:
  Statement(Sqlite& db, const std::string& sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(std::int64_t value);
  Statement& bind(int value) { return bind(std::int64_t{value}); }
  Statement& bind(bool value) { return bind(std::int64_t{value}); }
  Statement& bind(double value);
  Statement& bind(std::string_view text);
  Statement& bind(const char* text) { return bind(std::string_view(text)); }
  Statement& bind(const std::string& text) { return bind(std::string_view(text)); }
  Statement& blob(std::string_view bytes);
  Statement& null();
  template <class T>
  Statement& bind(const std::optional<T>& value) {
    return value ? bind(*value) : null();
  }

  /// True while there is a row.
  bool step();
  /// Executes a statement that returns no rows. It can then be bound again.
  void done();

  bool is_null(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_NULL; }
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_, column); }
  double number(int column) const { return sqlite3_column_double(statement_, column); }
  std::string text(int column) const;
  /// The value of a column, by the type of `out`.
  void get(int column, std::string& out) const { out = text(column); }
  void get(int column, double& out) const { out = number(column); }
  void get(int column, std::int64_t& out) const { out = integer(column); }
  void get(int column, bool& out) const { out = integer(column) != 0; }
  template <class T>
  void get(int column, std::optional<T>& out) const {
    out.reset();
    if (!is_null(column)) get(column, out.emplace());
  }
  /// The number of the column of this name; -1: there is none.
  int column(std::string_view name) const;

 private:
  void check(int status, const char* doing);
  Sqlite& db_;
  sqlite3_stmt* statement_ = nullptr;
  int next_ = 1;
};

/// A write transaction; rolled back unless committed.
class Transaction {
 public:
  explicit Transaction(Sqlite& db) : db_(db) { db_.run("BEGIN IMMEDIATE"); }
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Sqlite& db_;
  bool open_ = true;
};

}  // namespace dismantle::bench
