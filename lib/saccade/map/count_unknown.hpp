// SPDX-License-Identifier: Apache-2.0
#pragma once
// count_unknown: how much of a region is unknown.

#include "saccade/core/region.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

/// Unknown voxels whose centre lies in the region and in the map's workspace. O(voxels of the region).
[[nodiscard]] std::size_t count_unknown(const TsdfSnapshot& map, const Region& region);

}  // namespace saccade
