// SPDX-License-Identifier: Apache-2.0
#pragma once
// changed_bricks, changed_sectors: differences between two snapshots of a map; with_neighbors: all bricks these can
// affect.

#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/map/tsdf_grid.hpp"

namespace saccade {

/// Some bricks of one sector.
struct SectorBricks {
  Index3 sector;
  Mask512 bricks;  ///< bit child_index(brick)
  [[nodiscard]] bool operator==(const SectorBricks&) const = default;
};

/// Finds the bricks whose content differs between two states of one map, so that a reader updates only these. A brick
/// is listed if and only if the value, weight or colour of some voxel differs. (Rarely, a brick is listed that only
/// gained room for colours.) Bricks that appeared or were forgotten are listed; bricks rewritten with equal content are
/// not. The grids must have the same voxel size. With an empty grid as `before`, all bricks that hold anything are
/// listed.
///
/// Shared parts of the grids are skipped without a look at voxels: sectors by address, bricks by handle. The cost is
/// O(sectors + bricks of unshared sectors + voxels of unshared bricks up to their first difference). Sectors are in
/// z-y-x order, each with at least one changed brick. The thread count never changes the result.
[[nodiscard]] std::vector<SectorBricks> changed_sectors(const TsdfGrid& before, const TsdfGrid& after,
                                                        const Executor& executor);
/// Returns the indices of the changed bricks: by sector, then by brick within the sector, each in z-y-x order.
[[nodiscard]] std::vector<Index3> changed_bricks(const TsdfGrid& before, const TsdfGrid& after,
                                                 const Executor& executor);

/// Returns the given bricks and the up to 26 neighbours of each: all bricks in which the content within 8 voxels along
/// each axis may have changed. In the order of changed_sectors; sectors need not exist in any map.
[[nodiscard]] std::vector<SectorBricks> with_neighbors(std::span<const SectorBricks> sectors);

}  // namespace saccade
