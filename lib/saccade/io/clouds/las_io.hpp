// SPDX-License-Identifier: Apache-2.0
#pragma once
// LAS 1.0 to 1.4 (ASPRS), what laser scanners and surveys deliver: read with every field, labels written back as
// classes.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/io/files/column_table.hpp"

namespace saccade {

struct LasFile {
  /// x y z (f64, scaled and with the file's offset), intensity, returns, class_flags, classification, scan_angle,
  /// user_data, point_source, and where the point format has them gps_time, red green blue (u16, or u8 where the file
  /// holds 8 bits in 16) and nir.
  ColumnTable table;
  std::vector<std::byte> file;  ///< the file, byte for byte
  int point_format{0};          ///< 0 to 10
  std::size_t points_begin{0};  ///< byte of the first record
  std::size_t record_bytes{0};

  /// Greatest class that the point format holds: 31 in formats 0 to 5, 255 in 6 to 10.
  [[nodiscard]] std::uint32_t greatest_class() const { return point_format < 6 ? 31U : 255U; }
};

/// Tells whether a file begins like a LAS, compressed or not.
[[nodiscard]] bool is_las(std::string_view head);

/// Reads a LAS. Extra bytes, waveforms and records of variable length are kept in `file` alone.
/// @return unsupported for LAZ, with how to unpack it, and for other versions and point formats; corrupt_data with the
/// byte for headers that contradict themselves and truncated points. Memory is bounded by a multiple of the file's
/// size. O(file).
[[nodiscard]] Result<LasFile> parse_las(std::vector<std::byte> file);

/// Writes the file with new classes, one per point, atomically; all other bytes stay.
/// @return unsupported for a class that the point format cannot hold; size_mismatch unless there is one per point.
[[nodiscard]] Status write_las_classes(const std::filesystem::path& path, const LasFile& las,
                                       std::span<const std::uint32_t> classes);

}  // namespace saccade
