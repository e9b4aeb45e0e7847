// SPDX-License-Identifier: Apache-2.0
#pragma once
// TextColumn: one column of a text table, in the narrowest type that keeps its digits.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "saccade/io/files/column_table.hpp"

namespace saccade {

/// Column that grows by one number per row. Integers up to 64 bits are exact; others are double.
class TextColumn {
 public:
  /// Reserves room for `rows` numbers.
  void reserve(std::size_t rows);
  /// Adds the number of a token, including "nan" and "inf"; returns false when it is not a number. O(token).
  [[nodiscard]] bool append(std::string_view token);
  /// Returns the smallest and the largest number when all are integers, however they are spelled. O(rows).
  [[nodiscard]] std::optional<std::pair<double, double>> whole_range() const;
  /// Returns the number of a row. Expects the row in range.
  [[nodiscard]] double value(std::size_t row) const { return whole_ ? static_cast<double>(wholes_[row]) : reals_[row]; }
  /// Tells whether no number has a point or an exponent.
  [[nodiscard]] bool is_spelled_whole() const { return whole_; }

  /// Returns the type that keeps the column: i32, u32 or i64 for integers. Otherwise, or where `floating`: f32 when
  /// each number, printed with its digits in the text, reads back equal from a float; f64 in the other cases.
  [[nodiscard]] ColumnType type(bool floating) const;
  /// Converts the column. Expects a type that holds every number.
  [[nodiscard]] Column release(std::string name, ColumnType type) &&;

 private:
  std::vector<std::int64_t> wholes_;  ///< used while all numbers are integers
  std::vector<double> reals_;
  bool whole_{true};
  bool fits_float_{true};
};

}  // namespace saccade
