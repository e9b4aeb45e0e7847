// SPDX-License-Identifier: Apache-2.0
#pragma once
// CsvTable: rows of text and numbers as comma-separated values, quoted where RFC 4180 asks for it.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade {

/// CSV table. Each line ends in a line feed. Numbers are the shortest text that reads back to the same value, in any
/// locale.
class CsvTable {
 public:
  explicit CsvTable(const std::vector<std::string_view>& columns);

  // Each call adds a field to the row; nullopt leaves it empty.
  CsvTable& add(std::string_view text);
  CsvTable& add(double number);
  CsvTable& add(std::uint64_t number);
  CsvTable& add(const std::optional<double>& number);
  /// Adds fields as fields() has returned them.
  CsvTable& add_fields(std::string_view fields, std::size_t count);
  /// Ends the row. Expects one field per column.
  void end_row();

  /// Returns the fields of the current row, to be repeated in rows that begin alike.
  [[nodiscard]] std::string_view fields() const { return std::string_view{text_}.substr(row_); }
  [[nodiscard]] const std::string& text() const { return text_; }
  /// Writes the finished rows to a file and forgets them, so that a long table is written in parts. Expects no row
  /// under way. Answers io_failure.
  [[nodiscard]] Status move_to(AtomicFile& file);
  /// Writes atomically: the old or the complete new file exists. Answers io_failure.
  [[nodiscard]] Status write(const std::filesystem::path& path) const;

 private:
  void begin_field();
  template <class T>
  CsvTable& add_number(T number);

  std::size_t columns_;
  std::size_t fields_{0};  ///< fields of the current row
  std::size_t row_{0};     ///< where the current row begins
  std::string text_;
};

}  // namespace saccade
