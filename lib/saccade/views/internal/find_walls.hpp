// SPDX-License-Identifier: Apache-2.0
#pragma once
// find_walls: upright planes of a map that objects stand in front of.

#include <vector>

#include "saccade/views/internal/state_volume.hpp"
#include "saccade/views/supports.hpp"

namespace saccade {

/// Finds upright planes that were seen over at least `min_area_m2`, the largest first. Planes are fitted to small
/// patches of occupied voxels beside empty ones; voxels within one voxel of a plane belong to it. A plane with known
/// space behind it is the side of an object, not a wall. O(voxels); the thread count never changes a bit.
[[nodiscard]] std::vector<Wall> find_walls(const StateVolume& volume, double min_area_m2, const Executor& executor);

}  // namespace saccade
