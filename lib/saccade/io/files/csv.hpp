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
  /// Ends the row. Expects one field per column.
  void end_row();

  [[nodiscard]] const std::string& text() const { return text_; }
  /// Writes atomically: the old or the complete new file exists. Answers io_failure.
  [[nodiscard]] Status write(const std::filesystem::path& path) const;

 private:
  void begin_field();

  std::size_t columns_;
  std::size_t fields_{0};  ///< fields of the current row
  std::string text_;
};

}  // namespace saccade
