// SPDX-License-Identifier: Apache-2.0
#pragma once
// name_columns: names for the columns of a cloud whose file gives none.

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "saccade/io/files/column_table.hpp"

namespace saccade {

/// An array with more columns than this does not hold one point per row.
inline constexpr std::size_t kMostUnnamedColumns{64};

/// Meaning of three unnamed numbers of a point.
enum class Triple { none, colors_255, colors_1, normals };

/// Decides from the numbers of each point: integers of 0 … 255 with one above 1, numbers of 0 … 1, or unit vectors.
/// @param value  number k (0 to 2) of a row; rows are from 0. O(rows).
[[nodiscard]] Triple meaning_of(std::size_t rows, const std::function<double(std::size_t, std::size_t)>& value);

/// Names of `columns` (at least three): x y z, then intensity (four, or seven with colours) and r g b or nx ny nz by
/// the meaning of the last three (six or seven), otherwise value3, value4 ….
[[nodiscard]] std::vector<std::string> unnamed_columns(std::size_t columns, Triple last_three);

/// Names the columns of a table. Colours of 0 … 255 become u8. Expects at least three columns of one number each.
void name_columns(ColumnTable& table);

}  // namespace saccade
