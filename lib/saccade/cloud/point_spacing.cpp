// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/point_spacing.hpp"

#include <vector>

#include "saccade/cloud/nearest_neighbours.hpp"
#include "saccade/core/statistics.hpp"

namespace saccade {

std::optional<double> point_spacing_m(std::span<const Eigen::Vector3f> positions_m, const Executor& executor) {
  constexpr std::size_t kNeighbours{4};  // the first may lie at the same place
  const NearestNeighbours near = nearest_neighbours(positions_m, kNeighbours, executor);
  std::vector<float> distances_m;
  distances_m.reserve(near.order.size());
  for (std::size_t n = 0; n < near.order.size() && near.count > 0; ++n) {
    for (const std::uint32_t neighbour : near.of(n)) {
      const float distance_m = (near.positions_m[neighbour] - near.positions_m[n]).norm();
      if (!(distance_m > 0.0F)) continue;
      distances_m.push_back(distance_m);
      break;
    }
  }
  if (distances_m.empty()) return std::nullopt;
  return static_cast<double>(upper_median(std::move(distances_m)));
}

}  // namespace saccade
