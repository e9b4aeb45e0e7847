// SPDX-License-Identifier: Apache-2.0
#pragma once
// Clouds and labels of KITTI and SemanticKITTI: bare numbers, least significant byte first.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/io/files/column_table.hpp"

namespace saccade {

/// Parses a scan (.bin): x, y, z (metres, in the sensor's frame) and intensity of each point as f32.
/// @return corrupt_data for a size that is not a multiple of 16 bytes, or 0. O(file).
[[nodiscard]] Result<ColumnTable> parse_kitti_scan(std::span<const std::byte> file);

/// Parses labels (.label): 32 bits per point, the class in the lower 16, the instance in the upper 16.
/// @return corrupt_data for a size that is not a multiple of 4 bytes.
[[nodiscard]] Result<std::vector<std::uint32_t>> parse_kitti_labels(std::span<const std::byte> file);

}  // namespace saccade
