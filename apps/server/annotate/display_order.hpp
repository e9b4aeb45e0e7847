// SPDX-License-Identifier: Apache-2.0
#pragma once
// DisplayOrder: the order in which a page receives the points of a cloud. typical_spacing_m.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
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

/// Squared distances from a point to itself and its four nearest neighbours.
class FourNearest {
 public:
  FourNearest() { distances_m2_.fill(std::numeric_limits<float>::infinity()); }
  void add(float distance_m2) {
    if (!(distance_m2 < distances_m2_.back())) return;
    distances_m2_.back() = distance_m2;
    for (std::size_t i = distances_m2_.size() - 1; i > 0 && distances_m2_[i] < distances_m2_[i - 1]; --i) {
      std::swap(distances_m2_[i], distances_m2_[i - 1]);
    }
  }
  /// Returns the distance to the fourth; infinity: fewer were added.
  [[nodiscard]] float fourth_m2() const { return distances_m2_.back(); }

 private:
  std::array<float, 5> distances_m2_{};
};

/// Returns the median distance to the fourth nearest neighbour over some points of the order; 0 for fewer than five
/// points. O(points).
[[nodiscard]] double typical_spacing_m(std::span<const Eigen::Vector3f> positions_m, const DisplayOrder& order,
                                       const Executor& executor);
/// Returns the root of the upper median; 0 where it is not finite.
[[nodiscard]] double median_distance_m(std::span<float> distances_m2);

}  // namespace saccade::server
