// SPDX-License-Identifier: Apache-2.0
#pragma once
// find_supports: level surfaces of a map; fill_hull: the columns within the convex hull of some.

#include <span>

#include "saccade/views/internal/state_volume.hpp"
#include "saccade/views/supports.hpp"

namespace saccade {

/// Finds the level surfaces of at least `min_area_m2`, the largest first. Voxels within one layer of each other count
/// as one surface.
[[nodiscard]] std::vector<Support> find_supports(const StateVolume& volume, double min_area_m2);

/// Sets the columns (indices into a grid of `width` columns a row, x fastest) within the convex hull of `seen` to 1.
/// Expects columns of the grid.
void fill_hull(std::span<const std::uint32_t> seen, std::int32_t width, std::span<std::uint8_t> columns);

}  // namespace saccade
