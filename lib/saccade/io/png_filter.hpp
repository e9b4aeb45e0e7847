// SPDX-License-Identifier: Apache-2.0
#pragma once
// The five row filters of PNG (ISO/IEC 15948, clause 9), undone and applied.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace saccade {

/// Rows of `raw` (each 1 filter byte + row_bytes) without their filters; empty when a filter byte is unknown.
[[nodiscard]] std::vector<std::uint8_t> undo_png_filters(const std::vector<std::uint8_t>& raw, std::size_t row_bytes,
                                                         std::size_t pixel_bytes);
/// The inverse; for each row the filter with the smallest sum of absolute residuals.
[[nodiscard]] std::vector<std::uint8_t> apply_png_filters(const std::vector<std::uint8_t>& rows, std::size_t row_bytes,
                                                          std::size_t pixel_bytes);

}  // namespace saccade
