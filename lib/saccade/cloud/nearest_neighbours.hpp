// SPDX-License-Identifier: Apache-2.0
#pragma once
// nearest_neighbours: the K nearest points of every point of a cloud, exactly; estimate_normals, estimate_radii: what
// follows from them.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/unset_vector.hpp"

namespace saccade {

/// Points that are finite (and nearer than 10¹⁸ m), in the order of a k-d tree's leaves, so that near ones stand near
/// each other: node n is point order[n], at positions_m[n].
struct NearestNeighbours {
  UnsetVector<std::uint32_t> order;
  std::vector<Eigen::Vector3f> positions_m;
  std::size_t count{0};              ///< K, or one fewer than there are nodes
  UnsetVector<std::uint32_t> nodes;  ///< `count` per node, the nearest first, equally near ones in ascending order

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t node) const {
    return {nodes.data() + node * count, count};
  }
};

/// All eight points of a leaf look for theirs together, nearest boxes first. Of points at the K-th distance (squared,
/// in single precision) any may be taken; which depends on the points alone. The same for every thread count and
/// instruction set. Expects 1 ≤ k ≤ 64 and at most 2³² − 1 points. O(n (log n + k)), whatever the density; 4 k + 48
/// bytes per point.
[[nodiscard]] NearestNeighbours nearest_neighbours(std::span<const Eigen::Vector3f> positions_m, std::size_t k,
                                                   const Executor& executor);

/// The direction in which the points around a node vary least: least eigenvector of their covariance. `rounds` says how
/// far around reaches: 1, the K nearest; each more, the neighbours of these as well, those that are reached in several
/// ways counting as often. Either of the two directions; zero where there are fewer than three points around.
/// One per node. The same for every thread count and instruction set. O(n K rounds); 16 bytes per point while it works,
/// 80 with two rounds.
[[nodiscard]] std::vector<Eigen::Vector3f> estimate_normals(const NearestNeighbours& neighbours, int rounds,
                                                            const Executor& executor);

/// √2 times the distance to the fourth nearest point, which is how large a surfel of a camera's pixel is made beside
/// its neighbours; no more than four times the median of all, so that a stray point reaches no other surface. Without
/// four neighbours the last there is; 0 without any.
/// One per node. O(n).
[[nodiscard]] std::vector<float> estimate_radii(const NearestNeighbours& neighbours);

}  // namespace saccade
