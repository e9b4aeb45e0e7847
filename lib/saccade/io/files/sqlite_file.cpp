// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/sqlite_file.hpp"

#include <sqlite3.h>

#include <cerrno>
#include <cstring>

namespace saccade {
namespace {

/// Returns the operating system's reason, where SQLite kept one.
std::string system_reason(sqlite3* database) {
  const int code = database == nullptr ? 0 : sqlite3_system_errno(database);
  if (code == 0) return {};
  std::string reason{": "};
  reason += std::strerror(code);
  if (code == ENOSPC || code == EDQUOT || code == EFBIG) reason += "; make room or write elsewhere";
  return reason;
}

bool is_of_locking(int code) {
  return code == SQLITE_IOERR_LOCK || code == SQLITE_IOERR_RDLOCK || code == SQLITE_IOERR_UNLOCK ||
         code == SQLITE_IOERR_CHECKRESERVEDLOCK;
}

}  // namespace

void SqliteFile::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

Error SqliteFile::error(int code) const {
  const std::string where = path_.string();
  sqlite3* database = database_.get();
  switch (code & 0xff) {
    case SQLITE_NOTADB: return {Errc::corrupt_data, "is not an SQLite file; name another one", where};
    case SQLITE_CORRUPT:
      return {Errc::corrupt_data, "is a damaged SQLite file; move it away, or restore it from a copy", where};
    case SQLITE_FULL: return {Errc::io_failure, "cannot write: the disk is full; make room or write elsewhere", where};
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return {
          Errc::io_failure,
          "is being written by another process; try again when that one is done, or, if there is none, write to a file "
          "system that has locks",
          where};
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return {Errc::io_failure, "cannot be written; check the permissions of the file and its folder", where};
    case SQLITE_CANTOPEN: return {Errc::io_failure, "cannot be opened or created" + system_reason(database), where};
    case SQLITE_IOERR: {
      if (is_of_locking(code)) {
        return {Errc::io_failure,
                "cannot be locked" + system_reason(database) + "; choose a folder on a file system that has locks",
                where};
      }
      const bool reading = code == SQLITE_IOERR_READ || code == SQLITE_IOERR_SHORT_READ;
      return {Errc::io_failure, (reading ? "cannot be read" : "cannot be written") + system_reason(database), where};
    }
    case SQLITE_ERROR: {
      const std::string message = database == nullptr ? "" : sqlite3_errmsg(database);
      if (!message.starts_with("no such ")) break;
      return {Errc::corrupt_data, "was changed or damaged: there is " + message.substr(3), where};
    }
    case SQLITE_NOMEM: return {Errc::unavailable, "out of memory", where};
    default: break;
  }
  return {Errc::io_failure, std::string{"SQLite: "} + (database != nullptr ? sqlite3_errmsg(database) : "failed"),
          where};
}

Result<SqliteFile> SqliteFile::open(const std::filesystem::path& path, int busy_ms, int flags) {
  SqliteFile file;
  file.path_ = path;
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return Error{Errc::invalid_argument, "is a folder, not a file", path.string()};
  }
  sqlite3* database = nullptr;
  // Absolute, so that names such as ":memory:" or "file:x" are names of files.
  const std::string name = std::filesystem::absolute(path, ignored).string();
  // One thread at a time, so SQLite need not lock for each value.
  const int code = sqlite3_open_v2(name.c_str(), &database, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  file.database_.reset(database);
  if (code != SQLITE_OK) return file.error(code);
  sqlite3_busy_timeout(database, busy_ms);
  sqlite3_extended_result_codes(database, 1);
  return file;
}

Result<SqliteFile> SqliteFile::open(const std::filesystem::path& path, int busy_ms) {
  SACCADE_TRY(SqliteFile file, open(path, busy_ms, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE));
  if (sqlite3_db_readonly(file.database_.get(), "main") == 1) return file.error(SQLITE_READONLY);
  return file;
}

Result<SqliteFile> SqliteFile::open_existing(const std::filesystem::path& path, int busy_ms) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return Error{Errc::not_found, "there is no such file", path.string()};
  return open(path, busy_ms, SQLITE_OPEN_READWRITE);
}

Status SqliteFile::run(const std::string& sql) const {
  const int code = sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return error(code);
  return {};
}

Result<std::int64_t> SqliteFile::integer(const std::string& query) const {
  SACCADE_TRY(SqliteStatement statement, SqliteStatement::prepare(*this, query));
  SACCADE_TRY(const bool row, statement.step());
  if (!row) return error(SQLITE_CORRUPT);
  return statement.integer();
}

std::int64_t SqliteFile::last_row_id() const { return sqlite3_last_insert_rowid(database_.get()); }

int SqliteFile::changed_rows() const { return sqlite3_changes(database_.get()); }

void SqliteStatement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Result<SqliteStatement> SqliteStatement::prepare(const SqliteFile& file, std::string_view sql) {
  SqliteStatement statement{file};
  sqlite3_stmt* prepared = nullptr;
  const int code =
      sqlite3_prepare_v2(file.database_.get(), sql.data(), static_cast<int>(sql.size()), &prepared, nullptr);
  statement.statement_.reset(prepared);
  if (code != SQLITE_OK) return file.error(code);
  return statement;
}

void SqliteStatement::bind(std::string_view text) {
  // SQLite takes its own copy.
  SACCADE_EXPECTS(sqlite3_bind_text(statement_.get(), ++parameter_, text.data(), static_cast<int>(text.size()),
                                    SQLITE_TRANSIENT) == SQLITE_OK);
}

void SqliteStatement::bind(std::int64_t number) {
  SACCADE_EXPECTS(sqlite3_bind_int64(statement_.get(), ++parameter_, number) == SQLITE_OK);
}

void SqliteStatement::bind(double number) {
  SACCADE_EXPECTS(sqlite3_bind_double(statement_.get(), ++parameter_, number) == SQLITE_OK);
}

void SqliteStatement::bind(const std::optional<double>& number) {
  if (number) return bind(*number);
  SACCADE_EXPECTS(sqlite3_bind_null(statement_.get(), ++parameter_) == SQLITE_OK);
}

void SqliteStatement::bind_next_of(SqliteStatement& row) {
  SACCADE_EXPECTS(sqlite3_bind_value(statement_.get(), ++parameter_,
                                     sqlite3_column_value(row.statement_.get(), row.column_++)) == SQLITE_OK);
}

void SqliteStatement::restart() {
  sqlite3_reset(statement_.get());
  parameter_ = 0;
}

Result<bool> SqliteStatement::step() {
  column_ = 0;
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) return file_->error(code);
  return code == SQLITE_ROW;
}

Status SqliteStatement::run() {
  const int code = sqlite3_step(statement_.get());
  const Error error = code == SQLITE_DONE ? Error{} : file_->error(code);
  sqlite3_reset(statement_.get());
  parameter_ = 0;
  if (code != SQLITE_DONE) return error;
  return {};
}

std::string SqliteStatement::text() {
  const int column = column_++;
  const unsigned char* characters = sqlite3_column_text(statement_.get(), column);
  const auto bytes = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return characters == nullptr ? std::string{} : std::string{reinterpret_cast<const char*>(characters), bytes};
}

std::int64_t SqliteStatement::integer() { return sqlite3_column_int64(statement_.get(), column_++); }

double SqliteStatement::real() { return sqlite3_column_double(statement_.get(), column_++); }

std::optional<double> SqliteStatement::optional_real() {
  const int column = column_++;
  if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL) return std::nullopt;
  return sqlite3_column_double(statement_.get(), column);
}

Result<SqliteTransaction> SqliteTransaction::begin(const SqliteFile& file) {
  SACCADE_CHECK(file.run("BEGIN IMMEDIATE"));
  return SqliteTransaction{file};
}

SqliteTransaction::SqliteTransaction(SqliteTransaction&& other) noexcept : file_{other.file_} { other.file_ = nullptr; }

SqliteTransaction::~SqliteTransaction() {
  if (file_ != nullptr) static_cast<void>(file_->run("ROLLBACK"));
}

Status SqliteTransaction::commit() {
  SACCADE_CHECK(file_->run("COMMIT"));
  file_ = nullptr;
  return {};
}

}  // namespace saccade
