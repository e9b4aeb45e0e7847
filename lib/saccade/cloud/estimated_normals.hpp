// SPDX-License-Identifier: Apache-2.0
#pragma once
// estimate_normals: normals of points from their neighbours.

#include <Eigen/Core>
#include <vector>

#include "saccade/cloud/nearest_neighbours.hpp"

namespace saccade {

/// The direction in which the points around a node vary least: least eigenvector of their covariance. `rounds` says how
/// far around reaches: 1, the K nearest; each more, the neighbours of these as well, those that are reached in several
/// ways counting as often. Either of the two directions; zero where there are fewer than three points around.
/// One per node. The same for every thread count and instruction set. O(n K rounds); 16 bytes per point while it works,
/// 80 with two rounds.
[[nodiscard]] std::vector<Eigen::Vector3f> estimate_normals(const NearestNeighbours& neighbours, int rounds,
                                                            const Executor& executor);

}  // namespace saccade
