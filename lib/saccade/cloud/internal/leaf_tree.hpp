// SPDX-License-Identifier: Apache-2.0
#pragma once
// LeafTree: points in leaves of eight neighbouring points, with boxes around them.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/uninitialized_vector.hpp"

namespace saccade {

/// A k-d tree over points, stored as its leaves and as groups of eight boxes: around eight leaves, around eight such
/// groups, and so on. Constant; any number of threads may read.
class LeafTree {
 public:
  static constexpr std::size_t kWidth{8};  ///< points of a leaf, and children of a group
  static constexpr std::size_t kWidthLog2{3};

  /// x, y, z, and the bits of the point's number in the cloud. One vector, because building a tree mostly moves these.
  struct IndexedPoint {
    Eigen::Vector4f lanes;

    IndexedPoint() = default;
    IndexedPoint(const Eigen::Vector3f& p_m, std::uint32_t point) { lanes << p_m, std::bit_cast<float>(point); }
    [[nodiscard]] Eigen::Vector3f p_m() const { return lanes.head<3>(); }
    [[nodiscard]] std::uint32_t point() const { return std::bit_cast<std::uint32_t>(lanes.w()); }
  };
  using Lanes = std::array<float, kWidth>;
  /// Coordinates of a leaf's points. Unused places of the last leaf are farther from all points than these are from
  /// each other.
  struct alignas(32) Leaf {
    std::array<Lanes, 3> p_m;
  };
  /// Boxes of a group's children. Unused boxes of the last group are infinitely far away.
  struct alignas(32) Boxes {
    std::array<Lanes, 3> low_m;
    std::array<Lanes, 3> high_m;
  };

  /// Builds the tree. Expects at least one point, and all nearer than 10¹⁸ m. The thread count never changes the
  /// result. O(n log n); 31 bytes per point.
  LeafTree(UninitializedVector<IndexedPoint> sites, const Executor& executor);

  /// Points in the order of the leaves.
  [[nodiscard]] std::span<const IndexedPoint> sites() const { return sites_; }
  [[nodiscard]] std::span<const Leaf> leaves() const { return leaves_; }
  /// Boxes by level: groups of leaves, groups of groups, …, one group.
  [[nodiscard]] std::span<const std::vector<Boxes>> levels() const { return levels_; }
  [[nodiscard]] std::size_t first_of(std::size_t leaf) const { return leaf * kWidth; }
  [[nodiscard]] std::size_t end_of(std::size_t leaf) const { return std::min(sites_.size(), (leaf + 1) * kWidth); }

 private:
  struct Range;

  void split(const Range& range);
  void sort(const Range& range);
  void fill(std::size_t group);

  UninitializedVector<IndexedPoint> sites_;
  UninitializedVector<Leaf> leaves_;
  std::vector<std::vector<Boxes>> levels_;
};

}  // namespace saccade
