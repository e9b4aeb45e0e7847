// SPDX-License-Identifier: Apache-2.0
#pragma once
// for_each_in_row: the voxels of a row, for volumes derived from a map.

#include <algorithm>

#include "saccade/map/tsdf_grid.hpp"

namespace saccade {

/// Calls body(voxel) for the voxels from `first` up to `end_x` along x, in their order; unknown ones have w = 0.
/// O(voxels), one look-up a brick.
template <class Body>
void for_each_in_row(const TsdfGrid& grid, const Index3& first, std::int32_t end_x, const Body& body) {
  for (std::int32_t x = first.x; x < end_x;) {
    const Index3 voxel{x, first.y, first.z};
    const Sector* sector = grid.find(parent(parent(voxel)));
    const int edge = sector == nullptr ? kSectorVoxelEdge : kBrickEdge;
    const std::int32_t end = std::min((x & ~(edge - 1)) + edge, end_x);
    if (sector == nullptr) {
      for (; x < end; ++x) body(Voxel{});
    } else {
      const BrickRef& brick = sector->bricks[static_cast<std::size_t>(child_index(parent(voxel)))];
      for (; x < end; ++x) body(brick.voxel(child_index({x, first.y, first.z})));
    }
  }
}

}  // namespace saccade
