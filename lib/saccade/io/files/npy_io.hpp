// SPDX-License-Identifier: Apache-2.0
#pragma once
// Arrays of NumPy (.npy): the header of one, and a row of whole numbers read.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "saccade/core/result.hpp"
#include "saccade/io/files/column_table.hpp"

namespace saccade {

/// All that stands before the numbers, format 1.0, in C order. `type`: NumPy's name of it, such as <u4.
[[nodiscard]] std::string npy_header(std::string_view type, std::span<const std::size_t> shape);

/// A one-dimensional array of whole numbers, signed or not, of 8 to 64 bits; formats 1.0 and 2.0.
/// @return corrupt_data with the byte for a damaged header and for another number of bytes than the shape says;
/// unsupported for other types, byte orders, shapes and formats. O(file).
[[nodiscard]] Result<Column> parse_npy(std::span<const std::byte> file);

}  // namespace saccade
