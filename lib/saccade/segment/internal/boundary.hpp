// SPDX-License-Identifier: Apache-2.0
#pragma once
// BoundaryFinder: the surfels at which labels of a cloud meet.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/cloud/cell_index.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// Boundaries of a cloud (thesis eq. 4.16), for any number of labellings of it. A point is near the boundary when one
/// with another label is closer than T_eval; the nearest of these to each such point are the boundary. Of equally near
/// ones it is the first.
class BoundaryFinder {
 public:
  /// @param points   those that count, which are finite, in ascending order; for the others there is nothing.
  /// @param reach_m  T_eval.
  /// @return invalid_argument for a reach that is not finite and positive, or a point farther than two million reaches.
  /// Copies what it needs. O(points).
  [[nodiscard]] static Result<BoundaryFinder> create(std::span<const Eigen::Vector3f> positions_m,
                                                     std::span<const std::uint32_t> points, double reach_m,
                                                     const Executor& executor);

  /// Points of the boundary in ascending order. `labels` are as many as positions; kUnlabelled is a label as any other.
  /// O(points + points near the boundary · those around). The thread count never changes the result.
  [[nodiscard]] std::vector<std::uint32_t> boundary(std::span<const std::uint32_t> labels,
                                                    const Executor& executor) const;

 private:
  explicit BoundaryFinder(PointCells cells) : cells_{std::move(cells)} {}

  /// The node with another label nearest to a node, within reach; kUnlabelled: none.
  struct Labelled;
  [[nodiscard]] std::uint32_t nearest_other(const Labelled& labelled, std::size_t cell, std::uint32_t node) const;

  PointCells cells_;  ///< half as wide as the reach
  double reach_m_{0.0};
  std::vector<Eigen::Vector3f> positions_m_;  ///< by node, as the cells have them
  std::vector<std::uint32_t> around_starts_;  ///< of a cell's neighbours, one more than cells
  std::vector<std::uint32_t> around_;         ///< cells with a point that may be within reach, the nearest first
};

}  // namespace saccade
