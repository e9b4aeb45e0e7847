// SPDX-License-Identifier: Apache-2.0
#pragma once
// Support: a level surface that things stand on.

#include <cstdint>
#include <vector>

namespace saccade {

/// A table, a floor, a board of a shelf: a level layer of occupied voxels with empty ones above. Columns are counted in
/// a grid over the map's workspace, x fastest.
struct Support {
  std::int32_t top{0};                  ///< first layer of voxels above it
  double height_m{0.0};                 ///< world z of its surface
  double area_m2{0.0};                  ///< that was seen
  std::vector<std::uint8_t> columns{};  ///< 1: within the convex hull of what was seen
};

}  // namespace saccade
