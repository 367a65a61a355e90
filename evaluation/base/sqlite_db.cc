// SPDX-License-Identifier: BSD-3-Clause
// A thin owner around SQLite's C interface, with only what a record and a trial table need. Every
// return code is checked. An error becomes an SqliteError with the library's own words.
#include "evaluation/base/sqlite_db.h"

#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <sqlite3.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "sim/base/input_file.h"

namespace touchdown::evaluation {
namespace {

constexpr int kMostLength = 64 << 20;  // of a text or blob

void Check(sqlite3* db, int code) {
  if (code == SQLITE_OK || code == SQLITE_ROW || code == SQLITE_DONE) return;
  const char* file = sqlite3_db_filename(db, "main");
  throw SqliteError(std::string(file != nullptr ? file : "database") + ": " + sqlite3_errmsg(db));
}

}  // namespace

SqliteStatement::SqliteStatement(sqlite3* db, std::string_view sql) : db_(db) {
  Check(db_,
        sqlite3_prepare_v2(db_, sql.data(), static_cast<int>(sql.size()), &statement_, nullptr));
}

SqliteStatement::~SqliteStatement() { sqlite3_finalize(statement_); }

SqliteStatement::SqliteStatement(SqliteStatement&& other) noexcept
    : db_(other.db_), statement_(std::exchange(other.statement_, nullptr)) {}

void SqliteStatement::Bind(int index, double value) {
  if (!std::isfinite(value)) return BindNull(index);
  Check(db_, sqlite3_bind_double(statement_, index + 1, value));
}

void SqliteStatement::Bind(int index, std::int64_t value) {
  Check(db_, sqlite3_bind_int64(statement_, index + 1, value));
}

void SqliteStatement::Bind(int index, std::string_view value) {
  Check(db_, sqlite3_bind_text(statement_, index + 1, value.data(), static_cast<int>(value.size()),
                               SQLITE_TRANSIENT));
}

void SqliteStatement::Bind(int index, SqlBlob blob) {
  Check(db_, sqlite3_bind_blob64(statement_, index + 1, blob.bytes.data(), blob.bytes.size(),
                                 SQLITE_STATIC));
}

void SqliteStatement::Bind(int index, const SqlValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return Bind(index, *whole);
  if (const auto* number = std::get_if<double>(&value)) return Bind(index, *number);
  if (const auto* text = std::get_if<std::string>(&value)) return Bind(index, *text);
  BindNull(index);
}

void SqliteStatement::BindNull(int index) { Check(db_, sqlite3_bind_null(statement_, index + 1)); }

bool SqliteStatement::Step() {
  const int code = sqlite3_step(statement_);
  Check(db_, code);
  return code == SQLITE_ROW;
}

void SqliteStatement::RunRow(std::int64_t first, const std::vector<SqlValue>& values) {
  Bind(0, first);
  for (std::size_t i = 0; i < values.size(); ++i) Bind(static_cast<int>(i) + 1, values[i]);
  Run();
}

void SqliteStatement::RunRow(const std::vector<SqlValue>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) Bind(static_cast<int>(i), values[i]);
  Run();
}

void SqliteStatement::Reset() { Check(db_, sqlite3_reset(statement_)); }

std::vector<SqlValue> SqliteStatement::Row(int first) const {
  std::vector<SqlValue> row;
  for (int i = first; i < sqlite3_column_count(statement_); ++i) {
    switch (sqlite3_column_type(statement_, i)) {
      case SQLITE_INTEGER:
        row.emplace_back(Integer(i));
        break;
      case SQLITE_FLOAT:
        row.emplace_back(Real(i));
        break;
      case SQLITE_NULL:
        row.emplace_back();
        break;
      default:
        row.emplace_back(Text(i));
    }
  }
  return row;
}

bool SqliteStatement::IsNull(int column) const {
  return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}

bool SqliteStatement::IsNumber(int column) const {
  const int type = sqlite3_column_type(statement_, column);
  return type == SQLITE_FLOAT || type == SQLITE_INTEGER;
}

double SqliteStatement::Real(int column) const { return sqlite3_column_double(statement_, column); }

std::int64_t SqliteStatement::Integer(int column) const {
  return sqlite3_column_int64(statement_, column);
}

std::string SqliteStatement::Text(int column) const {
  const unsigned char* text = sqlite3_column_text(statement_, column);
  const int bytes = sqlite3_column_bytes(statement_, column);
  if (text == nullptr) return {};
  return {text, text + bytes};
}

bool IsSqliteFile(const std::string& path) {
  constexpr std::string_view kMagic = "SQLite format 3";
  return sim::HeadOfFile(path, kMagic.size()) == kMagic;
}

void RethrowNaming(const std::string& path, const char* what) {
  try {
    throw;
  } catch (const SqliteError& error) {
    throw BadInput(
        fmt::format("{}: not a {} that this build reads ({}).", path, what, error.what()));
  } catch (const nlohmann::json::exception&) {
    throw BadInput(fmt::format("{}: a text in its tables lacks a figure, or is no JSON.", path));
  } catch (const std::invalid_argument& error) {
    throw BadInput(fmt::format("{}: {}.", path, error.what()));
  }
}

SqliteDb::SqliteDb(const std::string& path, Mode mode) {
  std::error_code unknown;
  if (mode != Mode::kCreate && std::filesystem::exists(path, unknown) &&
      !std::filesystem::is_regular_file(path, unknown)) {
    throw SqliteError(path + ": it is no regular file");
  }
  // A reader must be able to recover what a killed writer left. So it opens for writing where the file allows it, and
  // the pragma below prevents writes.
  int flags = SQLITE_OPEN_READWRITE;
  if (mode == Mode::kCreate) flags |= SQLITE_OPEN_CREATE;
  const int code = sqlite3_open_v2(path.c_str(), &db_, flags, nullptr);
  if (code != SQLITE_OK) {
    const std::string words = db_ != nullptr ? sqlite3_errmsg(db_) : sqlite3_errstr(code);
    sqlite3_close(db_);
    throw SqliteError(path + ": " + words);
  }
  sqlite3_busy_timeout(db_, 10000);
  sqlite3_db_config(db_, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_db_config(db_, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_limit(db_, SQLITE_LIMIT_LENGTH, kMostLength);
  try {
    if (mode == Mode::kReadOnly) Execute("PRAGMA query_only=ON");
    if (mode != Mode::kCreate) RefuseComputedColumns();
  } catch (...) {
    sqlite3_close(db_);
    throw;
  }
}

void SqliteDb::RefuseComputedColumns() {
  SqliteStatement computed = Prepare(
      "SELECT t.name FROM sqlite_master AS t, pragma_table_xinfo(t.name) AS c "
      "WHERE t.type = 'table' AND c.hidden <> 0");
  if (computed.Step()) throw SqliteError("its table " + computed.Text(0) + " computes its columns");
}

SqliteDb::~SqliteDb() { sqlite3_close(db_); }

void SqliteDb::Execute(const std::string& sql) {
  Check(db_, sqlite3_exec(db_, sql.c_str(), nullptr, nullptr, nullptr));
}

SqliteTransaction::~SqliteTransaction() {
  if (!open_) return;
  try {
    db_.Execute("ROLLBACK");
  } catch (const SqliteError&) {
    // The file stays as it was before the transaction: SQLite rolls back on close as well.
  }
}

void SqliteTransaction::Commit() {
  db_.Execute("COMMIT");
  open_ = false;
}

}  // namespace touchdown::evaluation
