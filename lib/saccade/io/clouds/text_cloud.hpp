// SPDX-License-Identifier: Apache-2.0
#pragma once
// TextCloud: a point cloud as columns of text (.xyz, .txt, .csv, .pts, .asc …), one point per line, read and written.

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
  std::vector<std::byte> file;  ///< the file, byte for byte
  char separator{' '};          ///< comma, semicolon, or ' ' for any number of blanks and tabs
  bool decimal_comma{false};    ///< numbers have commas for points, as in 0,5
  std::size_t header_line{0};   ///< line that names the columns, from 1; 0: none
  std::size_t first_row_line{0};
};

/// Tells whether the suffix is .xyz, .txt, .csv, .pts, .asc, .xyzn or .xyzrgb, in either case.
[[nodiscard]] bool has_text_cloud_suffix(const std::filesystem::path& path);
/// Tells whether a text begins like a cloud: the first line that is not a comment is a row of at least three numbers or
/// names columns x, y and z; a number of points may precede it. Labels, one per line, are thus not clouds. `head`: the
/// file or its beginning. O(head).
[[nodiscard]] bool looks_like_text_cloud(std::string_view head);

/// Parses a cloud. Columns are separated by commas, by semicolons, or by blanks and tabs. Lines that start with # or //
/// are comments. A single number on the first line is the number of points. Names come from the next line, or from a
/// comment before the rows that names x, y and z. Without names the columns are x y z, then intensity (four columns), r
/// g b (six, the last three integers of 0 … 255 or numbers of 0 … 1) or nx ny nz (six, the last three of length 1),
/// intensity and these (seven, likewise), or value3, value4 …. Numbers may have commas for points where that is the
/// only way to read them. Integers become i32, u32 or i64, colours of 0 … 255 or 0 … 65535 u8 or u16. Others become f32
/// where that keeps their digits, otherwise f64; coordinates, normals and intensities are always floating point.
/// @return corrupt_data with the line for a word that is not a number, a row of another length, a wrong number of
/// points, decimal commas between commas, and names without x, y and z; unsupported for more than 1024 columns.
/// O(file); memory is bounded by a multiple of the file's size.
[[nodiscard]] Result<TextCloud> parse_text_cloud(std::vector<std::byte> file);

/// Writes a cloud atomically: a line of names (after # unless the path ends in .csv), then the points. Every number is
/// the shortest text that reads back to it, with commas in a .csv and blanks elsewhere. A column of several numbers per
/// point becomes name_0, name_1 …; padding (_) is dropped; colours packed in a float are written as the integer of
/// their bits.
[[nodiscard]] Status write_text_cloud(const std::filesystem::path& path, const ColumnTable& table);
/// Writes a cloud's original lines with a last column label, atomically. Where the suffix requires another separator
/// (comma or semicolon in a .csv, blanks in a .xyz) the numbers keep their characters and the names are those of the
/// table. An existing column label is renamed. Names that no line gave are added as a comment. Expects one label per
/// point.
[[nodiscard]] Status write_labelled_text(const std::filesystem::path& path, const TextCloud& cloud,
                                         std::span<const std::uint32_t> labels);

}  // namespace saccade
