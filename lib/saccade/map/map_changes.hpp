// SPDX-License-Identifier: Apache-2.0
#pragma once
// changed_bricks, changed_sectors: what differs between two snapshots of a map; with_neighbors: what that can touch.

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

/// The bricks whose content differs between two states of one map, so that a reader brings only these up to date.
/// Exact: a brick is listed if and only if the value, weight or colour of some voxel differs (or, rarely, it only got
/// room for colours); one that appeared or was forgotten is listed, one that was written with what it held is not. The
/// grids must have the same voxel size. An empty grid as `before` gives all bricks that hold anything.
///
/// What both grids share is passed over without a look at voxels: a sector by its address, a brick by its handle. So
/// the cost is O(sectors + bricks of sectors that are not shared + voxels of bricks that are neither shared nor differ
/// early on). Sectors in z-y-x order, none without a changed brick; the same for every thread count.
[[nodiscard]] std::vector<SectorBricks> changed_sectors(const TsdfGrid& before, const TsdfGrid& after,
                                                        const Executor& executor);
/// The same as brick indices: by sector, then by brick within the sector, each in z-y-x order.
[[nodiscard]] std::vector<Index3> changed_bricks(const TsdfGrid& before, const TsdfGrid& after,
                                                 const Executor& executor);

/// These bricks and the up to 26 around each: all whose content, or that of a voxel up to 8 voxels away along each
/// axis, may have changed. In the order of changed_sectors; sectors need not exist in any map.
[[nodiscard]] std::vector<SectorBricks> with_neighbors(std::span<const SectorBricks> sectors);

}  // namespace saccade
