// SPDX-License-Identifier: Apache-2.0
#pragma once
// read_labels: one number per point from any of the formats that write_labels has.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/io/files/column_table.hpp"

namespace saccade {

/// One number per line, comments (#, //) and a first line "label" aside.
/// @return corrupt_data with the line for a word that is no whole number, and for a second word.
[[nodiscard]] Result<Column> parse_label_lines(std::string_view text);

/// Labels of `points` points; 0 is none. From a .label all 32 bits (class + 65536 · instance), from a .npy an array of
/// whole numbers, from .xyz, .txt, .csv and .pts lines of one number each or a column label, else the field label of a
/// PCD or PLY.
/// @return size_mismatch when there are not so many; not_found without a field label; corrupt_data with the point for a
/// label that is negative, above 2^32 − 1 or no whole number; errors as of the readers of these formats. O(file).
[[nodiscard]] Result<std::vector<std::uint32_t>> read_labels(const std::filesystem::path& path, std::size_t points);

}  // namespace saccade
