// SPDX-License-Identifier: Apache-2.0
#pragma once
// estimate_radii: points of a cloud without radii as surfels.

#include <vector>

#include "saccade/cloud/nearest_neighbours.hpp"

namespace saccade {

/// √2 times the distance to the fourth nearest point, which is how large a surfel of a camera's pixel is made beside
/// its neighbours; no more than four times the median of all, so that a stray point reaches no other surface. Without
/// four neighbours the last there is; 0 without any.
/// One per node. O(n).
[[nodiscard]] std::vector<float> estimate_radii(const NearestNeighbours& neighbours);

}  // namespace saccade
