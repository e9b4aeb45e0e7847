// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which cells the mapped surface crosses, from the bricks' masks alone; bounds_of.

#include "saccade/map/tsdf_grid.hpp"

namespace saccade {

/// Bricks of a sector that have an occupied voxel among the corners of their cells.
[[nodiscard]] Mask512 bricks_with_occupied_corner(const SectorTable& sectors, const Index3& sector);

/// The cells of a brick that hold a zero crossing: all eight corners known, at least one occupied and one empty. A cell
/// lies between eight voxel centres and is named by its lowest corner.
[[nodiscard]] Mask512 crossed_cells(const SectorTable& sectors, const Index3& brick);

/// The smallest box around the bits set; of a mask with at least one.
[[nodiscard]] IndexBox bounds_of(const Mask512& mask);

}  // namespace saccade
