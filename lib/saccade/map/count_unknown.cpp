// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/tsdf_map.hpp"
#include "saccade/map/voxels_inside.hpp"

namespace saccade {

std::size_t count_unknown(const TsdfSnapshot& map, const Region& region) {
  const double e = map.config.voxel_size_m;
  const IndexBox voxels = voxels_with_center_in(bounds(region), e);
  if (voxels.empty()) return 0;
  std::size_t count = 0;
  parents(voxels).for_each([&](const Index3& brick) {
    Mask512 counted = map.grid.unknown_in(brick);
    if (counted.none()) return;
    const Index3 lo = brick * kBrickEdge;
    counted = counted & voxels_inside(region, lo, e);
    if (map.config.workspace) counted = counted & voxels_inside(*map.config.workspace, lo, e);
    count += static_cast<std::size_t>(counted.count());
  });
  return count;
}

}  // namespace saccade
