// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

std::size_t count_unknown(const TsdfSnapshot& map, const Region& region) {
  const double e = map.config.voxel_size_m;
  const IndexBox box = voxels_with_center_in(bounds(region), e);
  std::size_t count = 0;
  for (std::int32_t z = box.lo.z; z < box.hi.z; ++z) {
    for (std::int32_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int32_t x = box.lo.x; x < box.hi.x; ++x) {
        const Eigen::Vector3d p = voxel_center({x, y, z}, e);
        if (!contains(region, p) || (map.config.workspace && !contains(*map.config.workspace, p))) continue;
        count += map.grid.state({x, y, z}) == VoxelState::unknown ? 1 : 0;
      }
    }
  }
  return count;
}

}  // namespace saccade
