// SPDX-License-Identifier: Apache-2.0
#pragma once
// DisplayOrder: the order in which a page is given the points of a cloud. typical_spacing_m.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"

namespace saccade::server {

/// A random permutation of the finite points, always the same for as many: every beginning of it is an even sample of
/// the whole, whatever order the file has. 8 bytes per point.
class DisplayOrder {
 public:
  explicit DisplayOrder(std::span<const Eigen::Vector3f> positions_m);

  /// Finite points.
  [[nodiscard]] std::size_t size() const { return order_.size(); }
  /// The first of them.
  [[nodiscard]] std::span<const std::uint32_t> points(std::size_t from, std::size_t count) const {
    return std::span{order_}.subspan(from, count);
  }
  /// Whether a point is among the first so many; those that are not finite never are.
  [[nodiscard]] bool is_among(std::uint32_t point, std::size_t first) const { return rank_[point] < first; }

 private:
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> rank_;  ///< by point
};

/// The median over some points of the order of the distance to the fourth nearest neighbour; 0 for fewer than five
/// points. O(points).
[[nodiscard]] double typical_spacing_m(std::span<const Eigen::Vector3f> positions_m, const DisplayOrder& order,
                                       const Executor& executor);

}  // namespace saccade::server
