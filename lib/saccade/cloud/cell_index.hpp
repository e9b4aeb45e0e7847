// SPDX-License-Identifier: Apache-2.0
#pragma once
// CellIndex: cells of a regular grid, numbered in the order of insertion. PointCells: points of a cloud, grouped by the
// cell that they lie in.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

inline constexpr std::uint64_t kNoCell{~std::uint64_t{0}};
inline constexpr std::uint64_t kFarCell{kNoCell - 1};  ///< outside the range of an index
inline constexpr int kCellBits{21};                    ///< per axis

/// Returns the cell of edge length `size` that contains `place`, or kFarCell.
[[nodiscard]] inline std::uint64_t cell_at(const Eigen::Vector3f& place, double size) {
  constexpr double kHalf{static_cast<double>(1 << (kCellBits - 1))};
  std::uint64_t cell{0};
  for (const int axis : {0, 1, 2}) {
    const double index = std::floor(static_cast<double>(place[axis]) / size);
    if (!(index > 8.0 - kHalf && index < kHalf - 9.0)) return kFarCell;  // so that the neighbours of its block exist
    cell = (cell << kCellBits) | static_cast<std::uint64_t>(index + kHalf);
  }
  return cell;
}

/// Returns the 26 offsets (unsigned, wrapping) from a cell to its neighbours.
[[nodiscard]] inline const std::array<std::uint64_t, 26>& neighbour_offsets() {
  static const std::array<std::uint64_t, 26> offsets = [] {
    std::array<std::uint64_t, 26> made{};
    std::size_t next{0};
    for (const std::int64_t x : {-1, 0, 1}) {
      for (const std::int64_t y : {-1, 0, 1}) {
        for (const std::int64_t z : {-1, 0, 1}) {
          constexpr std::int64_t kAxis{std::int64_t{1} << kCellBits};
          if (x != 0 || y != 0 || z != 0) made[next++] = static_cast<std::uint64_t>((x * kAxis + y) * kAxis + z);
        }
      }
    }
    return made;
  }();
  return offsets;
}

/// Hash table of cells. One thread inserts; find is const.
class CellIndex {
 public:
  CellIndex() : slots_(std::size_t{1} << kFirstBits, kUnlabelled) {}

  [[nodiscard]] const std::vector<std::uint64_t>& cells() const { return cells_; }

  /// Returns the number of the cell, or kUnlabelled where it was not inserted.
  [[nodiscard]] std::uint32_t find(std::uint64_t cell) const { return slots_[slot_of(cell)]; }

  /// Returns the number of the cell, inserting it with the next number if it is new.
  std::uint32_t insert(std::uint64_t cell) {
    std::uint32_t& slot = slots_[slot_of(cell)];
    if (slot != kUnlabelled) return slot;
    const auto number = static_cast<std::uint32_t>(cells_.size());
    slot = number;
    cells_.push_back(cell);
    if (2 * cells_.size() > slots_.size()) grow();
    return number;
  }

 private:
  static constexpr int kFirstBits{12};

  /// Returns the slot of the cell, or the free slot where it would be inserted.
  [[nodiscard]] std::size_t slot_of(std::uint64_t cell) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = static_cast<std::size_t>((cell * 0x9E3779B97F4A7C15ULL) >> (64 - bits_));
    while (slots_[slot] != kUnlabelled && cells_[slots_[slot]] != cell) slot = (slot + 1) & mask;
    return slot;
  }
  void grow() {
    ++bits_;
    slots_.assign(std::size_t{1} << bits_, kUnlabelled);
    for (std::size_t i = 0; i < cells_.size(); ++i) slots_[slot_of(cells_[i])] = static_cast<std::uint32_t>(i);
  }

  int bits_{kFirstBits};
  std::vector<std::uint32_t> slots_;
  std::vector<std::uint64_t> cells_;
};

/// Points by cell. Cells are numbered in the order of their first points.
class PointCells {
 public:
  /// Groups the given points, which must be finite. Answers invalid_argument for a point farther than a million cells
  /// from the origin. O(points), one thread.
  [[nodiscard]] static Result<PointCells> create(std::span<const Eigen::Vector3f> positions_m,
                                                 std::span<const std::uint32_t> points, double size_m);

  [[nodiscard]] std::size_t size() const { return index_.cells().size(); }
  [[nodiscard]] double size_m() const { return size_m_; }
  /// Points grouped by cell, within a cell in the order given.
  [[nodiscard]] std::span<const std::uint32_t> points() const { return points_; }
  /// Range of a cell's points within points().
  [[nodiscard]] std::uint32_t first_of(std::size_t cell) const { return starts_[cell]; }
  [[nodiscard]] std::uint32_t end_of(std::size_t cell) const { return starts_[cell + 1]; }
  /// Returns the cell's position in the grid, as cell_at does.
  [[nodiscard]] std::uint64_t key(std::size_t cell) const { return index_.cells()[cell]; }
  /// Returns the number of the cell at a position, or kUnlabelled where no point lies.
  [[nodiscard]] std::uint32_t find(std::uint64_t key) const { return index_.find(key); }

 private:
  CellIndex index_;
  std::vector<std::uint32_t> starts_;  ///< first point of each cell; one entry more than cells
  std::vector<std::uint32_t> points_;
  double size_m_{0.0};
};

/// Returns the difference between cells that lie x, y, z steps apart.
[[nodiscard]] inline std::uint64_t cell_offset(int x, int y, int z) {
  constexpr std::int64_t kAxis{std::int64_t{1} << kCellBits};
  return static_cast<std::uint64_t>((x * kAxis + y) * kAxis + z);
}

/// Returns the corner of a cell with the smallest coordinates.
[[nodiscard]] Eigen::Vector3d low_corner_m(std::uint64_t key, double size_m);

/// Returns the indices of the points whose coordinates are finite.
[[nodiscard]] std::vector<std::uint32_t> finite_points(std::span<const Eigen::Vector3f> positions_m);

}  // namespace saccade
