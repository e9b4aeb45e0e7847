// SPDX-License-Identifier: Apache-2.0
#pragma once
// BoundaryFinder: the surfels where labels of a cloud meet.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/cloud/cell_index.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// Boundaries of a cloud (thesis eq. 4.16), for any number of labellings. A point is near the boundary when a point
/// with another label is closer than T_eval. The nearest of these to each such point form the boundary; the first at a
/// tie.
class BoundaryFinder {
 public:
  /// @param points   the finite points that count, in ascending order; others have no boundary.
  /// @param reach_m  T_eval.
  /// @return invalid_argument for a reach that is not finite and positive, or a point farther than two million reaches.
  /// Copies what it needs. O(points).
  [[nodiscard]] static Result<BoundaryFinder> create(std::span<const Eigen::Vector3f> positions_m,
                                                     std::span<const std::uint32_t> points, double reach_m,
                                                     const Executor& executor);

  /// Returns the points of the boundary in ascending order. `labels` has one entry per position; kUnlabelled is a label
  /// like any other. O(points + points near the boundary · their neighbours). The thread count never changes the
  /// result.
  [[nodiscard]] std::vector<std::uint32_t> boundary(std::span<const std::uint32_t> labels,
                                                    const Executor& executor) const;

 private:
  explicit BoundaryFinder(PointCells cells) : cells_{std::move(cells)} {}

  /// Finds the node with another label nearest to a node, within reach; kUnlabelled where there is none.
  struct Labelled;
  [[nodiscard]] std::uint32_t nearest_other(const Labelled& labelled, std::size_t cell, std::uint32_t node) const;

  PointCells cells_;  ///< half as wide as the reach
  double reach_m_{0.0};
  std::vector<Eigen::Vector3f> positions_m_;  ///< by node, in the order of the cells
  std::vector<std::uint32_t> around_starts_;  ///< first neighbour of each cell; one entry more than cells
  std::vector<std::uint32_t> around_;         ///< cells with a point that may be within reach, nearest first
};

}  // namespace saccade
