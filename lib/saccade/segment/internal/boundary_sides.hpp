// SPDX-License-Identifier: Apache-2.0
#pragma once
// BoundarySide, PointsLeft: two sets of points and the pairs within reach, for match_boundaries.

#include <Eigen/Core>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "saccade/cloud/cell_index.hpp"

namespace saccade {

/// Points of one boundary by node, with those of a cell adjacent; cells are as wide as the reach.
struct BoundarySide {
  PointCells cells;
  std::vector<Eigen::Vector3d> positions_m;
  std::vector<std::uint32_t> cell_of;        ///< by node
  std::vector<std::uint32_t> around_starts;  ///< first neighbour of each cell among the other side's; one entry more
                                             ///< than cells
  std::vector<std::uint32_t> around;

  [[nodiscard]] std::size_t size() const { return positions_m.size(); }
  [[nodiscard]] std::uint32_t point(std::uint32_t node) const { return cells.points()[node]; }

  [[nodiscard]] static Result<BoundarySide> create(std::span<const Eigen::Vector3f> positions_m,
                                                   std::span<const std::uint32_t> points, double reach_m);
  /// Finds the nearby cells of the other side. Call this once, before anything else.
  void look_at(const BoundarySide& other);
};

/// Nodes of a side that are not yet taken, in their order. Skipping taken nodes costs almost nothing.
class PointsLeft {
 public:
  explicit PointsLeft(std::size_t count) : next_(count + 1) { reset(); }
  void reset() { std::iota(next_.begin(), next_.end(), std::uint32_t{0}); }
  void take(std::uint32_t node) { next_[node] = node + 1; }
  /// Returns the first remaining node from `node` on, or the end of all.
  [[nodiscard]] std::uint32_t from(std::uint32_t node) {
    while (next_[node] != node) node = next_[node] = next_[next_[node]];
    return node;
  }

 private:
  std::vector<std::uint32_t> next_;
};

/// Iterates over the remaining nodes of the other side within reach of one node; others may be taken meanwhile.
class NearNodes {
 public:
  NearNodes(const BoundarySide& side, const BoundarySide& other, std::uint32_t node)
      : node_{node},
        cell_{side.around_starts[side.cell_of[node]]},
        cell_end_{side.around_starts[side.cell_of[node] + 1]} {
    if (cell_ < cell_end_) at_ = other.cells.first_of(side.around[cell_]);
  }

  [[nodiscard]] std::uint32_t node() const { return node_; }
  /// Returns the next node, or kUnlabelled at the end.
  [[nodiscard]] std::uint32_t next(const BoundarySide& side, const BoundarySide& other, PointsLeft& left,
                                   double reach_m2) {
    const Eigen::Vector3d& p_m = side.positions_m[node_];
    while (cell_ < cell_end_) {
      at_ = left.from(at_);
      if (at_ >= other.cells.end_of(side.around[cell_])) {
        if (++cell_ < cell_end_) at_ = other.cells.first_of(side.around[cell_]);
        continue;
      }
      const std::uint32_t found = at_++;
      if ((other.positions_m[found] - p_m).squaredNorm() <= reach_m2) return found;
    }
    return kUnlabelled;
  }

 private:
  std::uint32_t node_, cell_, cell_end_, at_{0};
};

}  // namespace saccade
