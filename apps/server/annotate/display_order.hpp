// SPDX-License-Identifier: Apache-2.0
#pragma once
// DisplayOrder: the order in which a page receives the points of a cloud. typical_spacing_m.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"

namespace saccade::server {

/// Random permutation of the finite points, constant for a given number: every prefix is an even sample of the whole,
/// whatever the file's order. 8 bytes per point.
class DisplayOrder {
 public:
  explicit DisplayOrder(std::span<const Eigen::Vector3f> positions_m);

  /// Returns the number of finite points.
  [[nodiscard]] std::size_t size() const { return order_.size(); }
  /// Returns `count` points from `from` on.
  [[nodiscard]] std::span<const std::uint32_t> points(std::size_t from, std::size_t count) const {
    return std::span{order_}.subspan(from, count);
  }
  /// Tells whether a point is among the first `first` ones; points that are not finite never are.
  [[nodiscard]] bool is_among(std::uint32_t point, std::size_t first) const { return rank_[point] < first; }

 private:
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> rank_;  ///< by point
};

/// Returns the median distance to the fourth nearest neighbour over some points of the order; 0 for fewer than five
/// points. O(points).
[[nodiscard]] double typical_spacing_m(std::span<const Eigen::Vector3f> positions_m, const DisplayOrder& order,
                                       const Executor& executor);

}  // namespace saccade::server
