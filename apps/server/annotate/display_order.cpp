// SPDX-License-Identifier: Apache-2.0
#include "server/annotate/display_order.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/core/seeded_random.hpp"
#include "saccade/core/statistics.hpp"

namespace saccade::server {

DisplayOrder::DisplayOrder(std::span<const Eigen::Vector3f> positions_m)
    : rank_(positions_m.size(), std::numeric_limits<std::uint32_t>::max()) {
  order_.reserve(positions_m.size());
  for (std::uint32_t point = 0; point < positions_m.size(); ++point) {
    if (positions_m[point].allFinite()) order_.push_back(point);
  }
  constexpr std::uint32_t kSeed{1};
  SeededRandom{kSeed}.shuffle(order_);
  for (std::size_t rank = 0; rank < order_.size(); ++rank) rank_[order_[rank]] = static_cast<std::uint32_t>(rank);
}

double typical_spacing_m(std::span<const Eigen::Vector3f> positions_m, const DisplayOrder& order,
                         const Executor& executor) {
  constexpr std::size_t kSamples{48};
  if (order.size() < 5) return 0.0;
  std::vector<float> distances_m2(std::min(kSamples, order.size()));
  executor.parallel_for(distances_m2.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t sample = begin; sample < end; ++sample) {
      const Eigen::Vector3f here_m = positions_m[order.points(sample, 1).front()];
      FourNearest nearest;
      for (const Eigen::Vector3f& p : positions_m) nearest.add((p - here_m).squaredNorm());
      distances_m2[sample] = nearest.fourth_m2();
    }
  });
  return median_distance_m(distances_m2);
}

double median_distance_m(std::span<float> distances_m2) {
  const float typical_m2 = upper_median(distances_m2);
  return std::isfinite(typical_m2) ? std::sqrt(static_cast<double>(typical_m2)) : 0.0;
}

}  // namespace saccade::server
