// SPDX-License-Identifier: Apache-2.0
#pragma once
// Cells that the mapped surface crosses, found from the bricks' masks alone; bounds_of.

#include "saccade/map/tsdf_grid.hpp"

namespace saccade {

/// Returns the bricks of a sector with an occupied voxel among the corners of their cells.
[[nodiscard]] Mask512 bricks_with_occupied_corner(const SectorTable& sectors, const Index3& sector);

/// Returns the cells of a brick that hold a zero crossing: all eight corners known, at least one occupied and one
/// empty. A cell lies between eight voxel centres and is named by its lowest corner.
[[nodiscard]] Mask512 crossed_cells(const SectorTable& sectors, const Index3& brick);

/// Returns the smallest box around the set bits. Expects at least one.
[[nodiscard]] IndexBox bounds_of(const Mask512& mask);

}  // namespace saccade
