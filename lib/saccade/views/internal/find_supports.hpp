// SPDX-License-Identifier: Apache-2.0
#pragma once
// find_supports: level surfaces of a map; hull_columns: the columns within the convex hull of some.

#include <span>

#include "saccade/views/internal/state_volume.hpp"
#include "saccade/views/supports.hpp"

namespace saccade {

/// Finds the level surfaces of at least `min_area_m2`, the largest first. Voxels within one layer of each other count
/// as one surface.
[[nodiscard]] std::vector<Support> find_supports(const StateVolume& volume, double min_area_m2);

/// Returns the columns within the convex hull of `seen`, which are distinct columns of a grid of `width` columns a row,
/// x fastest. O(columns of the hull).
[[nodiscard]] std::vector<std::uint32_t> hull_columns(std::span<const std::uint32_t> seen, std::int32_t width);

}  // namespace saccade
