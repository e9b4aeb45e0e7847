// SPDX-License-Identifier: Apache-2.0
#pragma once
// encode_sector, decode_sector: a sector as bytes for a SectorStore, in the machine's byte order.

#include <cstddef>
#include <span>
#include <vector>

#include "saccade/map/brick.hpp"

namespace saccade {

/// Returns the sector's summaries, a tag per brick, and the voxels of its free and dense bricks. 16-bit values are
/// written as their low bytes, then their high bytes, and colours by channel, which compress better. O(bytes).
[[nodiscard]] std::vector<std::byte> encode_sector(const Sector& sector);

/// Fills an all-unknown sector with the content that was encoded, to the bit. Answers corrupt_data for other bytes.
[[nodiscard]] Status decode_sector(std::span<const std::byte> bytes, Sector& sector);

}  // namespace saccade
