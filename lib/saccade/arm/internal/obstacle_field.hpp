// SPDX-License-Identifier: Apache-2.0
#pragma once
// ObstacleField: for each cell of the workspace how far its centre is from the nearest obstacle, brought up to date
// where cells changed.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/arm/internal/obstacle_cells.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// Distance transform of ObstacleCells and of boxes that stay where they are. Distances are those between a cell's
/// centre and the nearest point of an obstacle cell's cube, or of a box, and end at a reach.
///
/// Exact for cells: in half cells the gap between a centre and a cube k cells away along an axis is the whole number
/// max(2k − 1, 0), so the squared distance is a sum of three such squares, and its minimum is taken one axis after the
/// other, along x by the gaps between obstacles, then across rows. A pass goes only through rows that a change of the
/// pass before can reach, and stops where nothing changed; hence the same as made anew, to the bit, for any thread
/// count.
class ObstacleField {
 public:
  static constexpr int kMostReach_cells{127};  ///< squares fit 16 bits

  /// Everything beyond reach_cells, from 1 to kMostReach_cells, counts as that far. O(cells · (reach + boxes)).
  ObstacleField(const ObstacleCells& cells, int reach_cells, std::span<const Box> fixtures, const Executor& executor);

  /// Takes over the last update of the same cells. O(rows within reach of those that changed · reach).
  void update(const ObstacleCells& cells, const Executor& executor);

  /// In half cells; cells are counted from the lower corner of the box. Exact where an obstacle cell is nearest; for a
  /// fixture the root of the squared distance rounded down to a whole number.
  [[nodiscard]] float distance(const Index3& cell) const { return distances_[index_of(cell)]; }
  [[nodiscard]] float reach() const { return static_cast<float>(2 * reach_cells_); }
  /// All of them; index_of says where.
  [[nodiscard]] std::span<const float> distances() const { return distances_; }
  [[nodiscard]] std::size_t index_of(const Index3& cell) const {
    return (static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(cell.y)) *
               stride_ +
           static_cast<std::size_t>(cell.x);
  }
  [[nodiscard]] std::size_t row_stride() const { return stride_; }

  /// Equal distances.
  [[nodiscard]] bool operator==(const ObstacleField& other) const { return distances_ == other.distances_; }

 private:
  void measure_fixtures(std::span<const Box> fixtures, const ObstacleCells& cells, const Executor& executor);
  void distances_along(const std::uint64_t* row, std::uint16_t* out) const;

  int reach_cells_;
  Index3 size_;
  std::size_t stride_;                   ///< cells from a row to the next, padded
  std::vector<std::uint16_t> costs_;     ///< squared gap of so many cells
  std::vector<std::uint16_t> rising_;    ///< the same at most reach², for a whole row
  std::vector<std::uint16_t> falling_;   ///< backwards
  std::vector<std::uint16_t> far_away_;  ///< a row of reach²
  std::vector<std::uint16_t> fixtures_;  ///< squared distance from fixtures; empty without any
  std::vector<std::uint16_t> along_x_;   ///< squared distance from obstacles of the same row
  std::vector<std::uint16_t> along_xy_;  ///< of the same layer
  std::vector<float> distances_;
};

}  // namespace saccade
