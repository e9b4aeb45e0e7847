// SPDX-License-Identifier: Apache-2.0
#pragma once
// ObstacleCells: the coarse cells of the workspace that hold an occupied or unknown voxel, updated where the map
// changed.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

/// The planner's map. Thesis §2.1: voxels are grouped into cells of 4 cm, and a cell is an obstacle if any of its
/// voxels is occupied or unknown. Only voxels whose centre lies in the map's workspace count; outside it nothing is an
/// obstacle.
///
/// Cells are cubes of a whole number of voxels along each edge, the number nearest to the desired size, so that each
/// voxel lies in one cell: 4 cm at 5.8 mm are 7 voxels, 4.06 cm. Cell (0, 0, 0) begins at the origin of the world. A
/// cell at the border of the workspace is an obstacle as a whole.
///
/// One writer; const use from many threads is safe.
class ObstacleCells {
 public:
  static constexpr int kMostVoxelsAlong{256};
  static constexpr double kMostCells{1 << 26};

  /// Returns the cells of a map in which nothing has been seen.
  /// @return invalid_argument for a map without a workspace, for a cell size that is not positive or more than
  /// kMostVoxelsAlong voxels, and when the workspace holds more than kMostCells cells or no voxel.
  [[nodiscard]] static Result<ObstacleCells> create(const TsdfConfig& map, double cell_size_m,
                                                    bool unknown_is_obstacle);

  struct Changes {
    std::size_t bricks{0};  ///< bricks whose obstacle voxels differ
    std::size_t cells{0};   ///< cells that became obstacles or ceased to be obstacles
  };
  /// Brings the cells up to date with the map; the result equals new cells. The configuration must be that of create().
  /// Skips what is shared with the previous state, and bricks that are free in both. O(sectors in the workspace +
  /// bricks written since that hold an obstacle, or did). The thread count never changes the result.
  Changes update(const TsdfGrid& map, const Executor& executor);

  [[nodiscard]] int voxels_along_cell() const { return voxels_along_; }
  [[nodiscard]] double cell_edge_m() const { return cell_edge_m_; }
  /// Returns the cells of the workspace; cell c covers [c, c + 1) · cell_edge_m.
  [[nodiscard]] const IndexBox& box() const { return box_; }
  [[nodiscard]] Index3 size() const { return box_.hi - box_.lo; }
  /// Returns the world coordinates of a cell.
  [[nodiscard]] Box bounds_of(const Index3& cell) const;
  [[nodiscard]] std::size_t obstacle_count() const { return obstacle_count_; }
  /// Returns false outside box().
  [[nodiscard]] bool is_obstacle(const Index3& cell) const;

  /// Rows of cells along x, numbered z · size().y + y from the lower corner of box(). Cell x is bit x % 64 of word x /
  /// 64; a zero word follows the last.
  [[nodiscard]] std::size_t row_count() const { return row_changed_.size(); }
  [[nodiscard]] const std::uint64_t* row(std::size_t index) const { return bits_.data() + index * words_per_row_; }
  /// Tells per row whether the last update changed a cell; after the first, all rows are marked.
  [[nodiscard]] std::span<const std::uint8_t> row_changed() const { return row_changed_; }

  /// Tells whether cells and obstacles are equal.
  [[nodiscard]] bool operator==(const ObstacleCells& other) const;

 private:
  /// Partition of a brick by cells along one axis: part i holds voxels start[i] … start[i + 1] − 1 of the brick, in
  /// cell first_cell + i. Voxels outside the workspace are in no part.
  struct AxisPartition {
    std::int32_t first_cell;
    std::int32_t parts;
    std::array<std::uint8_t, kBrickEdge + 1> start;
    std::array<std::uint64_t, kBrickEdge> rows;     ///< voxels of a slice in part i, if the axis is y
    std::array<std::uint64_t, kBrickEdge> columns;  ///< or if it is x
  };
  using Words = std::array<std::uint64_t, kBrickEdge>;
  /// Cells that a brick starts or ceases to make an obstacle; one entry per brick and cell.
  struct ObstacleChanges {
    std::vector<std::uint32_t> begun;
    std::vector<std::uint32_t> ended;
  };

  ObstacleCells() = default;
  void cut_axis(std::size_t axis, std::int32_t voxel_lo, std::int32_t voxel_hi);
  void reset_to_unknown();
  [[nodiscard]] Words stops_of(const BrickRef& brick) const;
  [[nodiscard]] Mask512 may_differ(const Sector* before, const Sector* after) const;
  [[nodiscard]] std::size_t compare(const Index3& sector, const Sector* before, const Sector* after,
                                    ObstacleChanges& flips) const;
  void compare(const Index3& brick, const Words& before, const Words& after, ObstacleChanges& flips) const;
  void add_all(const Index3& brick, std::vector<std::uint32_t>& to) const;
  void toggle(std::uint32_t cell);

  bool unknown_is_obstacle_{true};
  int voxels_along_{1};
  double cell_edge_m_{0.0};
  IndexBox box_;
  IndexBox bricks_;                                 ///< bricks of the workspace
  std::array<std::vector<AxisPartition>, 3> cuts_;  ///< per axis, the bricks of bricks_
  std::size_t words_per_row_{0};
  std::size_t obstacle_count_{0};
  std::vector<std::uint16_t> makers_;  ///< per cell: number of bricks with an obstacle voxel in it
  std::vector<std::uint64_t> bits_;
  std::vector<std::uint8_t> row_changed_;
  bool updated_{false};
  TsdfGrid seen_;  ///< map that the cells are up to date with
};

}  // namespace saccade
