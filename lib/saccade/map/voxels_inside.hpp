// SPDX-License-Identifier: Apache-2.0
#pragma once
// voxels_inside: the voxels of a brick that a region or a box of voxels contains.

#include "saccade/core/region.hpp"
#include "saccade/map/brick.hpp"

namespace saccade {

/// Voxels of the brick from voxel `lo` whose centre lies in the region: contains() of every centre, to the bit. Most
/// are decided many at a time, with slack, and only those at the border one by one.
[[nodiscard]] Mask512 voxels_inside(const Region& region, const Index3& lo, double voxel_size_m);

/// Those that lie in a box of voxels.
[[nodiscard]] Mask512 voxels_inside(const IndexBox& box, const Index3& lo);

}  // namespace saccade
