// SPDX-License-Identifier: Apache-2.0
#pragma once
// SqliteFile, SqliteStatement: an SQLite database with errors as values.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "saccade/core/result.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace saccade {

/// Open database file. Errors carry the file's path: corrupt_data for a file that is not a database or is damaged,
/// io_failure for a full disk, a missing permission, or another process that locks the file too long. One thread
/// at a time, statements included; several processes may open the file.
class SqliteFile {
 public:
  /// Opens or creates the file. busy_ms: how long a write waits for another process.
  [[nodiscard]] static Result<SqliteFile> open(const std::filesystem::path& path, int busy_ms);
  /// Opens a file that exists, to read it. It may be one that cannot be written; what a killed process left half done
  /// in it is undone. Answers not_found.
  [[nodiscard]] static Result<SqliteFile> open_existing(const std::filesystem::path& path, int busy_ms);

  /// Runs statements that return no rows.
  [[nodiscard]] Status run(const std::string& sql) const;
  [[nodiscard]] Result<std::int64_t> integer(const std::string& query) const;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::int64_t last_row_id() const;
  /// Returns the number of rows changed by the last statement.
  [[nodiscard]] int changed_rows() const;
  /// Returns the Error of a result code of SQLite.
  [[nodiscard]] Error error(int code) const;

 private:
  friend class SqliteStatement;
  struct Close {
    void operator()(sqlite3* database) const;
  };
  SqliteFile() = default;
  [[nodiscard]] static Result<SqliteFile> open(const std::filesystem::path& path, int busy_ms, int flags);
  std::filesystem::path path_;
  std::unique_ptr<sqlite3, Close> database_;
};

/// Statement: prepared once, its ? bound from 1 on, stepped through its rows, and restarted. The file must outlive it.
/// Expects existing columns and parameters.
class SqliteStatement {
 public:
  [[nodiscard]] static Result<SqliteStatement> prepare(const SqliteFile& file, std::string_view sql);

  // Each call binds the next parameter.
  void bind(std::string_view text);
  void bind(std::int64_t number);
  void bind(double number);
  void bind(const std::optional<double>& number);
  /// Binds the next column of another statement's row, whatever its type.
  void bind_next_of(SqliteStatement& row);

  /// Tells whether there is another row.
  [[nodiscard]] Result<bool> step();
  /// Prepares a statement with rows for new values.
  void restart();
  /// Runs a statement without rows, and prepares it for new values.
  [[nodiscard]] Status run();

  /// Goes back to the first column of the row.
  void read_again() { column_ = 0; }

  // Each call reads the next column of the row.
  [[nodiscard]] std::string text();
  [[nodiscard]] std::int64_t integer();
  [[nodiscard]] double real();
  [[nodiscard]] std::optional<double> optional_real();

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  explicit SqliteStatement(const SqliteFile& file) : file_{&file} {}
  const SqliteFile* file_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int parameter_{0};
  int column_{0};
};

/// Transaction that acquires the write lock at once. It is undone without a commit.
class SqliteTransaction {
 public:
  [[nodiscard]] static Result<SqliteTransaction> begin(const SqliteFile& file);
  SqliteTransaction(SqliteTransaction&& other) noexcept;
  SqliteTransaction& operator=(SqliteTransaction&&) = delete;
  ~SqliteTransaction();
  [[nodiscard]] Status commit();

 private:
  explicit SqliteTransaction(const SqliteFile& file) : file_{&file} {}
  const SqliteFile* file_;
};

}  // namespace saccade
