// SPDX-License-Identifier: Apache-2.0
#pragma once
// TextColumn: one column of a table in text, in the narrowest type that says what its digits say.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "saccade/io/files/column_table.hpp"

namespace saccade {

/// Grows by one number per row. Whole numbers are kept to the bit up to 64 bits; others as double.
class TextColumn {
 public:
  /// Room for so many numbers.
  void reserve(std::size_t rows);
  /// Adds the number that a token spells, "nan" and "inf" included; false when it is none. O(token).
  [[nodiscard]] bool append(std::string_view token);
  /// The smallest and the largest number when all are whole, however they are spelled. O(rows).
  [[nodiscard]] std::optional<std::pair<double, double>> whole_range() const;
  /// Whether no number has a point or an exponent.
  [[nodiscard]] bool is_spelled_whole() const { return whole_; }

  /// Type that keeps the column: i32, u32 or i64 for whole numbers; else, or where `floating`, f32 when each number,
  /// printed with the digits that the text gives, reads the same from a float; else f64.
  [[nodiscard]] ColumnType type(bool floating) const;
  /// Expects a type that holds every number.
  [[nodiscard]] Column release(std::string name, ColumnType type) &&;

 private:
  std::vector<std::int64_t> wholes_;  ///< as long as all are whole
  std::vector<double> reals_;
  bool whole_{true};
  bool fits_float_{true};
};

}  // namespace saccade
