// SPDX-License-Identifier: Apache-2.0
#pragma once
// voxels_inside: the voxels of a brick that a region or a box of voxels contains.

#include "saccade/core/region.hpp"
#include "saccade/map/brick.hpp"

namespace saccade {

/// Returns the voxels of the brick from voxel `lo` whose centre lies in the region, to the bit as contains() of every
/// centre. Most are decided many at a time, with slack; only voxels at the border are tested one by one.
[[nodiscard]] Mask512 voxels_inside(const Region& region, const Index3& lo, double voxel_size_m);

/// Returns the voxels of the brick that lie in a box of voxels.
[[nodiscard]] Mask512 voxels_inside(const IndexBox& box, const Index3& lo);

}  // namespace saccade
