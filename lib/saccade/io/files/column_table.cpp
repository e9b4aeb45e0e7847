// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/column_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace saccade {
namespace {

/// Calls visit(T{}) with the C++ type of a column.
template <class Visitor>
decltype(auto) with_type(ColumnType type, Visitor visit) {
  switch (type) {
    case ColumnType::i8: return visit(std::int8_t{});
    case ColumnType::u8: return visit(std::uint8_t{});
    case ColumnType::i16: return visit(std::int16_t{});
    case ColumnType::u16: return visit(std::uint16_t{});
    case ColumnType::i32: return visit(std::int32_t{});
    case ColumnType::u32: return visit(std::uint32_t{});
    case ColumnType::i64: return visit(std::int64_t{});
    case ColumnType::u64: return visit(std::uint64_t{});
    case ColumnType::f32: return visit(float{});
    default: return visit(double{});
  }
}

template <class T>
T converted(double value) {
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<T>(value);
  } else {
    const double rounded = std::nearbyint(value);
    if (std::isnan(rounded)) return 0;
    if (rounded <= static_cast<double>(std::numeric_limits<T>::min())) return std::numeric_limits<T>::min();
    if (rounded >= static_cast<double>(std::numeric_limits<T>::max())) return std::numeric_limits<T>::max();
    return static_cast<T>(rounded);
  }
}

}  // namespace

std::size_t bytes_of(ColumnType type) {
  return with_type(type, [](auto zero) { return sizeof(zero); });
}

double Column::value(std::size_t row, std::size_t k) const {
  return with_type(type, [&](auto number) {
    const std::size_t offset = (row * count + k) * sizeof(number);
    SACCADE_EXPECTS(k < count && offset + sizeof(number) <= bytes.size());
    std::memcpy(&number, &bytes[offset], sizeof(number));
    return static_cast<double>(number);
  });
}

void Column::set_value(std::size_t row, double value, std::size_t k) {
  with_type(type, [&](auto number) {
    const std::size_t offset = (row * count + k) * sizeof(number);
    SACCADE_EXPECTS(k < count && offset + sizeof(number) <= bytes.size());
    number = converted<decltype(number)>(value);
    std::memcpy(&bytes[offset], &number, sizeof(number));
  });
}

const Column* ColumnTable::find(std::string_view name) const {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

std::string ColumnTable::unused_name(std::string_view name) const {
  std::string unused{name};
  for (int i = 2; find(unused) != nullptr; ++i) unused = std::string{name} + std::to_string(i);
  return unused;
}

std::size_t ColumnTable::row_bytes() const {
  std::size_t bytes = 0;
  for (const Column& column : columns) bytes += column.row_bytes();
  return bytes;
}

Status ColumnTable::validate() const {
  for (const Column& column : columns) {
    if (column.name.empty() || column.name.find_first_of(" \t\r\n") != std::string::npos) {
      return Error{Errc::invalid_argument, "a column needs a name without blanks", "'" + column.name + "'"};
    }
    if (column.count == 0 || column.bytes.size() != rows * column.row_bytes()) {
      return Error{Errc::size_mismatch, "a column's values are not as many as the rows", column.name};
    }
  }
  return {};
}

}  // namespace saccade
