// SPDX-License-Identifier: Apache-2.0
#pragma once
// ObstacleField: the distance of each workspace cell's centre from the nearest obstacle, updated where cells changed.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/arm/internal/obstacle_cells.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// Distance transform of ObstacleCells and of static boxes. Distances are measured between a cell's centre and the
/// nearest point of an obstacle cell's cube, or of a box, and are limited to a reach.
///
/// Exact for cells. In half cells the gap between a centre and a cube k cells away along an axis is the integer max(2k
/// − 1, 0). The squared distance is thus a sum of three such squares, and its minimum is taken one axis after the
/// other, along x by the gaps between obstacles, then across rows. A pass visits only rows that a change of the
/// previous pass can reach, and stops where nothing changed. The result equals a new field to the bit, for any thread
/// count.
class ObstacleField {
 public:
  static constexpr int kMostReach_cells{127};  ///< squares fit 16 bits

  /// Builds the field. Distances beyond reach_cells, from 1 to kMostReach_cells, count as that far. O(cells · (reach +
  /// boxes)).
  ObstacleField(const ObstacleCells& cells, int reach_cells, std::span<const Box> fixtures, const Executor& executor);

  /// Applies the last update of these cells. O(rows within reach of changed ones · reach).
  void update(const ObstacleCells& cells, const Executor& executor);

  /// Returns the distance in half cells; cells count from the lower corner of the box. Exact where an obstacle cell is
  /// nearest; for a fixture the square root of the squared distance rounded down to an integer.
  [[nodiscard]] float distance(const Index3& cell) const { return distances_[index_of(cell)]; }
  [[nodiscard]] float reach() const { return static_cast<float>(2 * reach_cells_); }
  /// Returns all distances, in the order of index_of.
  [[nodiscard]] std::span<const float> distances() const { return distances_; }
  [[nodiscard]] std::size_t index_of(const Index3& cell) const {
    return (static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(cell.y)) *
               stride_ +
           static_cast<std::size_t>(cell.x);
  }
  [[nodiscard]] std::size_t row_stride() const { return stride_; }

  /// Tells whether all distances are equal.
  [[nodiscard]] bool operator==(const ObstacleField& other) const { return distances_ == other.distances_; }

 private:
  void measure_fixtures(std::span<const Box> fixtures, const ObstacleCells& cells, const Executor& executor);
  void distances_along(const std::uint64_t* row, std::uint16_t* out) const;

  int reach_cells_;
  Index3 size_;
  std::size_t stride_;                   ///< cells from one row to the next, padded
  std::vector<std::uint16_t> costs_;     ///< squared gap by number of cells
  std::vector<std::uint16_t> rising_;    ///< squared gaps limited to reach², for a whole row
  std::vector<std::uint16_t> falling_;   ///< rising_ backwards
  std::vector<std::uint16_t> far_away_;  ///< a row of reach²
  std::vector<std::uint16_t> fixtures_;  ///< squared distance from fixtures; empty without fixtures
  std::vector<std::uint16_t> along_x_;   ///< squared distance from obstacles of one row
  std::vector<std::uint16_t> along_xy_;  ///< squared distance from obstacles of one layer
  std::vector<float> distances_;
};

}  // namespace saccade
