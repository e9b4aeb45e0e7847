// SPDX-License-Identifier: Apache-2.0
#pragma once
// One number of a column to and from text and bytes; shared by the PLY and PCD readers and writers.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/io/files/column_table.hpp"

namespace saccade {

/// Appends the number of a token as `type`; returns false when it is not a number or does not fit the type.
[[nodiscard]] bool append_token(std::string_view token, ColumnType type, std::vector<std::byte>& out);
/// Appends the shortest text that reads back to the same number.
void append_text(const std::byte* value, ColumnType type, std::string& out);
/// Reverses the bytes of each number of `width` bytes.
void swap_bytes(std::byte* values, std::size_t bytes, std::size_t width);

}  // namespace saccade
