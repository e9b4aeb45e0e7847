// SPDX-License-Identifier: Apache-2.0
#pragma once
// Column, ColumnTable: named columns of numbers of any type, as in PLY and PCD files, without loss.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

enum class ColumnType : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };
inline constexpr auto kColumnTypeNames = make_names<ColumnType>({{ColumnType::i8, "i8"},
                                                                 {ColumnType::u8, "u8"},
                                                                 {ColumnType::i16, "i16"},
                                                                 {ColumnType::u16, "u16"},
                                                                 {ColumnType::i32, "i32"},
                                                                 {ColumnType::u32, "u32"},
                                                                 {ColumnType::i64, "i64"},
                                                                 {ColumnType::u64, "u64"},
                                                                 {ColumnType::f32, "f32"},
                                                                 {ColumnType::f64, "f64"}});
[[nodiscard]] constexpr std::string_view to_string(ColumnType type) { return kColumnTypeNames.of(type); }

[[nodiscard]] std::size_t bytes_of(ColumnType type);

/// ColumnType of a C++ type.
template <class T>
[[nodiscard]] constexpr ColumnType column_type_of() {
  static_assert(std::is_arithmetic_v<T> && sizeof(T) <= 8);
  if constexpr (std::is_floating_point_v<T>) return sizeof(T) == 4 ? ColumnType::f32 : ColumnType::f64;
  constexpr int kLog = sizeof(T) == 1 ? 0 : (sizeof(T) == 2 ? 1 : (sizeof(T) == 4 ? 2 : 3));
  return static_cast<ColumnType>(2 * kLog + (std::is_signed_v<T> ? 0 : 1));
}

/// rows × count numbers of one type, row by row, in the machine's byte order.
struct Column {
  std::string name;
  ColumnType type{ColumnType::f32};
  std::size_t count{1};  ///< numbers per row
  std::vector<std::byte> bytes;

  [[nodiscard]] std::size_t row_bytes() const { return count * bytes_of(type); }
  /// Number `k` of a row, converted. Expects row and k in range.
  [[nodiscard]] double value(std::size_t row, std::size_t k = 0) const;
  /// Stores a number, rounded and clamped to an integer type's range (NaN becomes 0 there).
  void set_value(std::size_t row, double value, std::size_t k = 0);
  /// Returns a copy of the numbers as T; empty unless T is exactly the column's type.
  template <class T>
  [[nodiscard]] std::vector<T> values() const {
    if (column_type_of<T>() != type) return {};
    std::vector<T> out(bytes.size() / sizeof(T));
    std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
    return out;
  }
  [[nodiscard]] bool operator==(const Column&) const = default;
};

/// Columns of equal length. Names need not be unique (PCD pads with "_"); find() gives the first.
struct ColumnTable {
  std::size_t rows{0};
  std::vector<Column> columns;

  /// Returns the column, or nullptr.
  [[nodiscard]] const Column* find(std::string_view name) const;
  /// Returns the name, with 2, 3 … appended if a column has it already.
  [[nodiscard]] std::string unused_name(std::string_view name) const;
  [[nodiscard]] std::size_t row_bytes() const;
  /// Appends a column of `values` (count per row). Expects as many as rows·count; the first column sets the rows.
  template <class T>
  void add(std::string name, std::span<const T> values, std::size_t count = 1) {
    SACCADE_EXPECTS(count > 0 && values.size() % count == 0);
    if (columns.empty()) rows = values.size() / count;
    SACCADE_EXPECTS(values.size() == rows * count);
    const auto bytes = std::as_bytes(values);
    columns.push_back({std::move(name), column_type_of<T>(), count, {bytes.begin(), bytes.end()}});
  }
  /// Answers size_mismatch or invalid_argument when a column's bytes, count or name does not fit.
  [[nodiscard]] Status validate() const;
  [[nodiscard]] bool operator==(const ColumnTable&) const = default;
};

}  // namespace saccade
