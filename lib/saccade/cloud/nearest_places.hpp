// SPDX-License-Identifier: Apache-2.0
#pragma once
// nearest_places: the K nearest points of every point of a cloud in which many points may lie at one place.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "saccade/cloud/nearest_neighbours.hpp"

namespace saccade {

/// A point that lies exactly where another one does.
struct PointCopy {
  std::uint32_t point;
  std::uint32_t original;  ///< the first point of that place
};

struct NearestPlaces {
  NearestNeighbours neighbours;   ///< among all points but the copies
  std::vector<PointCopy> copies;  ///< ascending by point; none where no place is crowded
};

/// As nearest_neighbours, but where half of a point's k nearest lie where it does, as in clouds that were merged or
/// whose coordinates were rounded, only the first point of its place is searched for and found: among copies of
/// themselves points would see no other place. The origin is left as it is: sensors put there what they did not
/// measure. A cloud without such places has the result of nearest_neighbours. Expects what that does. The thread count
/// and instruction set never change the result. Costs a second search where there are copies.
[[nodiscard]] NearestPlaces nearest_places(std::span<const Eigen::Vector3f> positions_m, std::size_t k,
                                           const Executor& executor,
                                           const std::shared_ptr<const DiskMemory>& disk = {});

}  // namespace saccade
