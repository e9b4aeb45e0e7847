// SPDX-License-Identifier: Apache-2.0
#pragma once
// NumPy arrays (.npy): writing a header, reading an array of any type, a row of integers, and a table.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/io/files/column_table.hpp"

namespace saccade {

/// Returns everything before the numbers, format 1.0, in C order. `type`: NumPy's name of it, such as <u4.
[[nodiscard]] std::string npy_header(std::string_view type, std::span<const std::size_t> shape);

/// Tells whether a file begins like an array of NumPy.
[[nodiscard]] bool is_npy(std::string_view head);
/// Tells whether the header, whole in `head`, is of a table as parse_npy_table reads it: two dimensions, or records.
[[nodiscard]] bool is_npy_table(std::string_view head);

/// Array as it lies in a file. Borrows the file.
struct NpyArray {
  std::string_view type;  ///< NumPy's name of it, such as <u4
  std::vector<std::size_t> shape;
  bool is_fortran{false};  ///< columns first
  std::span<const std::byte> bytes;
  std::size_t offset{0};  ///< place of the bytes in the file
};

/// Reads the header of an array of one field; formats 1.0 and 2.0. Does not compare the shape with the bytes.
/// @return corrupt_data with the byte for a damaged header; unsupported for several fields and other formats.
[[nodiscard]] Result<NpyArray> parse_npy_array(std::span<const std::byte> file);

/// Reads a one-dimensional array of integers, signed or not, of 8 to 64 bits; formats 1.0 and 2.0.
/// @return corrupt_data with the byte for a damaged header and for a number of bytes that contradicts the shape;
/// unsupported for other types, byte orders, shapes and formats. O(file).
[[nodiscard]] Result<Column> parse_npy(std::span<const std::byte> file);

/// Reads a table: an array of two dimensions, in C or Fortran order, whose columns have no names, or an array of
/// records with one number per field. Integers and floats of 8 to 64 bits, either byte order; formats 1.0 and 2.0.
/// @return errors as parse_npy. O(file).
[[nodiscard]] Result<ColumnTable> parse_npy_table(std::span<const std::byte> file);

}  // namespace saccade
