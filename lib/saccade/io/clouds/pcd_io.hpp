// SPDX-License-Identifier: Apache-2.0
#pragma once
// PCD v0.7 point clouds: ascii, binary, binary_compressed; keeps every field and count.

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>

#include "saccade/core/result.hpp"
#include "saccade/io/files/column_table.hpp"

namespace saccade {

enum class PcdFormat { ascii, binary, binary_compressed };
inline constexpr auto kPcdFormatNames = make_names<PcdFormat>(
    {{PcdFormat::ascii, "ascii"}, {PcdFormat::binary, "binary"}, {PcdFormat::binary_compressed, "binary_compressed"}});

struct PcdFile {
  ColumnTable table;  ///< fields in order, including padding ("_"); rows = width · height
  std::size_t width{0};
  std::size_t height{1};                                               ///< 1: not organised
  std::array<double, 7> viewpoint{0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};  ///< tx ty tz qw qx qy qz
  PcdFormat format{PcdFormat::binary};                                 ///< format that it was read in
};

/// Reads versions 0.6 and 0.7. corrupt_data with the line or byte for a bad header, fields that do not match, wrong
/// numbers of points, and truncated data; unsupported for another kind of data. Memory is bounded by what the file can
/// hold. O(file).
[[nodiscard]] Result<PcdFile> parse_pcd(std::span<const std::byte> file);
[[nodiscard]] Result<PcdFile> read_pcd(const std::filesystem::path& path);
/// Writes atomically. Binary keeps every bit; ascii keeps every number, but not the bits of a NaN. Answers
/// size_mismatch unless width · height is the number of rows.
[[nodiscard]] Status write_pcd(const std::filesystem::path& path, const PcdFile& file,
                               PcdFormat format = PcdFormat::binary);
/// Writes an unorganised cloud.
[[nodiscard]] Status write_pcd(const std::filesystem::path& path, const ColumnTable& table,
                               PcdFormat format = PcdFormat::binary);

}  // namespace saccade
