// SPDX-License-Identifier: Apache-2.0
#pragma once
// nearest_neighbours: the exact K nearest points of every point of a cloud. estimate_normals, estimate_radii: estimates
// derived from them.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/disk_memory.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/uninitialized_vector.hpp"

namespace saccade {

/// Graph of nearest neighbours. Its nodes are the finite points (nearer than 10¹⁸ m) in the order of a k-d tree's
/// leaves, so that nearby points are nearby in memory: node n is point order[n], at positions_m[n].
struct NearestNeighbours {
  UninitializedVector<std::uint32_t> order;
  std::vector<Eigen::Vector3f> positions_m;
  std::size_t count{0};             ///< K, limited to one fewer than the number of nodes
  DiskVector<std::uint32_t> nodes;  ///< `count` per node, nearest first, equally near ones in ascending order

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t node) const {
    return {nodes.data() + node * count, count};
  }
};

/// Finds the k nearest points of each point. The eight points of a leaf search together, nearest boxes first. Where
/// several points lie at the K-th distance (squared, in single precision), any of them may be taken; the choice depends
/// on the points alone. The thread count and instruction set never change the result. Expects 1 ≤ k ≤ 64 and at most
/// 2³² − 1 points. O(n (log n + k)), whatever the density; 4 k + 48 bytes per point, 4 k of them
/// on `disk` where there is one.
[[nodiscard]] NearestNeighbours nearest_neighbours(std::span<const Eigen::Vector3f> positions_m, std::size_t k,
                                                   const Executor& executor,
                                                   std::shared_ptr<const DiskMemory> disk = {});

/// Estimates one normal per node: the direction in which the points around it vary least, the eigenvector of their
/// covariance for the smallest eigenvalue. Its sign is arbitrary. It is zero where fewer than three points lie around.
/// `rounds` sets how far "around" reaches: 1 takes the K nearest; each further round takes their neighbours as well,
/// counting points as often as they are reached. The thread count and instruction set never change the result. O(n K
/// rounds); 16 bytes per point while it works, 80 with two rounds, 64 of them where the neighbours are, in memory or on
/// disk.
[[nodiscard]] std::vector<Eigen::Vector3f> estimate_normals(const NearestNeighbours& neighbours, int rounds,
                                                            const Executor& executor);

/// Estimates one radius per node: √2 times the distance to the fourth nearest point, the size that a surfel of a
/// camera's pixel has relative to its neighbours. The radius is at most four times the median of all, so that a stray
/// point reaches no other surface. Nodes with fewer than four neighbours use the last one, those with none get 0. O(n).
[[nodiscard]] std::vector<float> estimate_radii(const NearestNeighbours& neighbours);

}  // namespace saccade
