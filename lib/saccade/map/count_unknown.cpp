// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

std::size_t count_unknown(const TsdfSnapshot& map, const Region& region) {
  const double e = map.config.voxel_size_m;
  std::size_t count = 0;
  voxels_with_center_in(bounds(region), e).for_each([&](const Index3& voxel) {
    const Eigen::Vector3d p = voxel_center(voxel, e);
    if (!contains(region, p) || (map.config.workspace && !contains(*map.config.workspace, p))) return;
    count += map.grid.state(voxel) == VoxelState::unknown ? 1 : 0;
  });
  return count;
}

}  // namespace saccade
