// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/nearest_neighbours.hpp"

#include "saccade/core/statistics.hpp"

#include <algorithm>
#include <numbers>

namespace saccade {

std::vector<float> estimate_radii(const NearestNeighbours& neighbours) {
  constexpr std::size_t kFourth{3};
  constexpr float kMostMedians{4.0F};
  std::vector<float> radii_m(neighbours.order.size(), 0.0F);
  if (neighbours.count == 0) return radii_m;
  const std::size_t which = std::min(kFourth, neighbours.count - 1);
  for (std::size_t n = 0; n < radii_m.size(); ++n) {
    radii_m[n] = std::numbers::sqrt2_v<float> *
                 (neighbours.positions_m[neighbours.of(n)[which]] - neighbours.positions_m[n]).norm();
  }
  const float most_m = kMostMedians * upper_median(std::vector<float>{radii_m});
  for (float& radius_m : radii_m) radius_m = std::min(radius_m, most_m);
  return radii_m;
}

}  // namespace saccade
