// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace touchdown::evaluation {

/// SQLite refused: the message names the file and SQLite's own words.
struct SqliteError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The value of a column: nothing, a whole number, a number or a text.
using SqlValue = std::variant<std::monostate, std::int64_t, double, std::string>;

/// Bytes that are no text. They outlive the statement's run.
struct SqlBlob {
  std::string_view bytes;
};

/// A prepared statement. Parameters and columns are counted from 0. Must not outlive its database.
class SqliteStatement {
 public:
  SqliteStatement(sqlite3* db, std::string_view sql);
  ~SqliteStatement();
  SqliteStatement(SqliteStatement&& other) noexcept;
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;
  SqliteStatement& operator=(SqliteStatement&&) = delete;

  void Bind(int index, double value);  ///< a number that is not finite is stored as NULL
  void Bind(int index, std::int64_t value);
  void Bind(int index, int value) { Bind(index, static_cast<std::int64_t>(value)); }
  void Bind(int index, bool value) { Bind(index, static_cast<std::int64_t>(value)); }
  void Bind(int index, std::string_view value);
  void Bind(int index, const char* value) { Bind(index, std::string_view(value)); }
  void Bind(int index, const std::string& value) { Bind(index, std::string_view(value)); }
  template <typename T>
  void Bind(int index, const std::optional<T>& value) {
    if (value) {
      Bind(index, *value);
    } else {
      BindNull(index);
    }
  }
  void Bind(int index, const SqlValue& value);
  void Bind(int index, SqlBlob blob);
  void BindNull(int index);

  /// Runs to the next row; false when there is none. @throws SqliteError
  bool Step();

  /// Binds all values in order, runs to the end and is ready for the next row of values.
  template <typename... Values>
  void Run(const Values&... values) {
    int index = 0;
    (Bind(index++, values), ...);
    while (Step()) {
    }
    Reset();
  }

  /// The same for a row that begins with `first`, then has `values`.
  void RunRow(std::int64_t first, const std::vector<SqlValue>& values);
  void RunRow(const std::vector<SqlValue>& values);

  void Reset();

  /// The row's columns from `first` on.
  std::vector<SqlValue> Row(int first = 0) const;
  bool IsNull(int column) const;
  bool IsNumber(int column) const;  ///< whole or not
  double Real(int column) const;
  std::int64_t Integer(int column) const;
  std::string Text(int column) const;

 private:
  sqlite3* db_ = nullptr;
  sqlite3_stmt* statement_ = nullptr;
};

/// One open SQLite file. Not to be used from two threads at a time.
class SqliteDb {
 public:
  enum class Mode { kReadOnly, kReadWrite, kCreate };

  /// `path` may be ":memory:". Another process that is just writing is waited for, 10 s at most. What
  /// could run without end does not: views and triggers of the file do not work, computed columns are refused.
  /// @throws SqliteError when the file cannot be opened or created, or is no regular one.
  SqliteDb(const std::string& path, Mode mode);
  ~SqliteDb();
  SqliteDb(const SqliteDb&) = delete;
  SqliteDb& operator=(const SqliteDb&) = delete;

  /// Runs one or more statements that return nothing.
  void Execute(const std::string& sql);

  SqliteStatement Prepare(std::string_view sql) { return SqliteStatement(db_, sql); }

 private:
  void RefuseComputedColumns();

  sqlite3* db_ = nullptr;
};

/// Whether the file begins as SQLite's do.
bool IsSqliteFile(const std::string& path);

/// To be called in a catch block, of what reads the database at `path`. `what` that is: "record".
/// @throws BadInput that names the file, for an SqliteError, an std::invalid_argument, or JSON that lacks something; else
/// what was caught
[[noreturn]] void RethrowNaming(const std::string& path, const char* what);

/// Calls read(), which reads the database at `path`. @throws as RethrowNaming
template <typename Read>
auto NamingFile(const std::string& path, const char* what, const Read& read) {
  try {
    return read();
  } catch (...) {
    RethrowNaming(path, what);
  }
}

/// Begins a transaction; rolls it back unless Commit() was called.
class SqliteTransaction {
 public:
  explicit SqliteTransaction(SqliteDb& db) : db_(db) { db_.Execute("BEGIN"); }
  ~SqliteTransaction();
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;
  void Commit();

 private:
  SqliteDb& db_;
  bool open_ = true;
};

}  // namespace touchdown::evaluation
