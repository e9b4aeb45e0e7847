// SPDX-License-Identifier: Apache-2.0
#pragma once
// TextCloud: a point cloud as columns of text (.xyz, .txt, .csv, .pts), one point per line, read and written.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/io/files/column_table.hpp"

namespace saccade {

struct TextCloud {
  ColumnTable table;
  std::vector<std::byte> file;  ///< every letter as it was read
  char separator{' '};          ///< comma, semicolon, or ' ' for any number of blanks and tabs
  std::size_t header_line{0};   ///< the line that names the columns, from 1; 0: none does
  std::size_t first_row_line{0};
};

/// .xyz, .txt, .csv or .pts, in letters of either case.
[[nodiscard]] bool has_text_cloud_suffix(const std::filesystem::path& path);
/// Whether the first line that is no comment is a row of at least three numbers or names columns x, y and z; before it
/// may stand a number of points. So labels, one per line, are none. `head`: the file or its beginning. O(head).
[[nodiscard]] bool looks_like_text_cloud(std::string_view head);

/// Columns are separated by commas, by semicolons, or by blanks and tabs. Lines that start with # or // are comments. A
/// number alone on the first line is the number of points. Names come from the next line, or from a comment before the
/// rows that names x, y and z; without them the columns are x y z, and then intensity (four columns), r g b (six, the
/// last three whole numbers of 0 … 255), intensity r g b (seven, in the same way), or value3, value4 …. Whole numbers
/// become i32, u32 or i64, colours of 0 … 255 or 0 … 65535 u8 or u16; others f32 where their digits say no more, else
/// f64; coordinates, normals and intensities are floating point always.
/// @return corrupt_data with the line for a word that is no number, a row of another length, a number of points that is
/// wrong, and names without x, y and z; unsupported for more than 1024 columns. O(file); memory is bounded by a
/// multiple of the file's size.
[[nodiscard]] Result<TextCloud> parse_text_cloud(std::vector<std::byte> file);

/// Atomic. A line of names (after # unless the path ends in .csv), then the points: every number as the shortest text
/// that reads back to it, with commas in a .csv and blanks elsewhere. A column of several numbers per point becomes
/// name_0, name_1 …; padding (_) is left out; colours packed in a float are written as the whole number of their bits.
[[nodiscard]] Status write_text_cloud(const std::filesystem::path& path, const ColumnTable& table);
/// Atomic. The lines of the cloud as they were, with a last column label; where the suffix asks for another separator
/// (comma or semicolon in a .csv, blanks in a .xyz) the numbers are kept letter by letter and the names are those of
/// the table. An earlier column label gets another name. Names that no line gave are added as a comment. Expects one
/// label per point.
[[nodiscard]] Status write_labelled_text(const std::filesystem::path& path, const TextCloud& cloud,
                                         std::span<const std::uint32_t> labels);

}  // namespace saccade
