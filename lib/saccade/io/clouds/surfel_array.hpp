// SPDX-License-Identifier: Apache-2.0
#pragma once
// encode_surfels, decode_surfels: a map of surfels as an array of NumPy, to the bit.

#include <cstddef>
#include <span>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// Returns a file of NumPy (.npy): 32-bit floats, a row per surfel in the order of their ids, 12 columns: x, y, z,
/// radius (metres), normal, w_s, red, green, blue in [0, 1], and the weight of the colour. O(surfels).
[[nodiscard]] std::vector<std::byte> encode_surfels(const SurfelMap& map);

/// Returns the map that encode_surfels wrote, with equal bits.
/// @return corrupt_data for values that are not finite and weights or radii below 0, for another shape or type, and for
/// a damaged or truncated file; errors of parse_npy_array. O(file).
[[nodiscard]] Result<SurfelMap> decode_surfels(std::span<const std::byte> file);

}  // namespace saccade
