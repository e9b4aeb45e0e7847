// SPDX-License-Identifier: Apache-2.0
#pragma once
// PointCells: points of a cloud by the cells of a grid that they lie in.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/cloud/cell_index.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Cells are numbered in the order of their first points.
class PointCells {
 public:
  /// Of the points that are named, which are finite. invalid_argument for one farther than a million cells from the
  /// origin. O(points), one thread.
  [[nodiscard]] static Result<PointCells> create(std::span<const Eigen::Vector3f> positions_m,
                                                 std::span<const std::uint32_t> points, double size_m);

  [[nodiscard]] std::size_t size() const { return index_.cells().size(); }
  [[nodiscard]] double size_m() const { return size_m_; }
  /// By cell, in the order given within one.
  [[nodiscard]] std::span<const std::uint32_t> points() const { return points_; }
  /// Of its points among these.
  [[nodiscard]] std::uint32_t first_of(std::size_t cell) const { return starts_[cell]; }
  [[nodiscard]] std::uint32_t end_of(std::size_t cell) const { return starts_[cell + 1]; }
  /// The cell's place in the grid, as cell_at has it.
  [[nodiscard]] std::uint64_t key(std::size_t cell) const { return index_.cells()[cell]; }
  /// The number of a cell by its place; kUnlabelled where no point lies.
  [[nodiscard]] std::uint32_t find(std::uint64_t key) const { return index_.find(key); }

 private:
  CellIndex index_;
  std::vector<std::uint32_t> starts_;  ///< one more than cells
  std::vector<std::uint32_t> points_;
  double size_m_{0.0};
};

/// Steps along the axes from cell to cell.
[[nodiscard]] inline std::uint64_t cell_offset(int x, int y, int z) {
  constexpr std::int64_t kAxis{std::int64_t{1} << kCellBits};
  return static_cast<std::uint64_t>((x * kAxis + y) * kAxis + z);
}

/// The corner of a cell that has the least coordinates.
[[nodiscard]] Eigen::Vector3d low_corner_m(std::uint64_t key, double size_m);

/// The points with a finite place.
[[nodiscard]] std::vector<std::uint32_t> finite_points(std::span<const Eigen::Vector3f> positions_m);

}  // namespace saccade
