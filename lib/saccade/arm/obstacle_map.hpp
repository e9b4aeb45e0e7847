// SPDX-License-Identifier: Apache-2.0
#pragma once
// ObstacleMap: an arm's obstacles, from the map and declared fixtures, and the distance of spheres from them.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/hidden.hpp"
#include "saccade/core/region.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

class ObstacleCells;
class ObstacleField;
namespace obstacle {
struct FieldView;
}

struct ObstacleConfig {
  double cell_size_m{0.04};        ///< thesis §2.1; rounded to a whole number of voxels
  bool unknown_is_obstacle{true};  ///< thesis §2.1; false: only occupied voxels are obstacles
  double max_distance_m{0.5};      ///< limit of computed distances
  std::vector<Box> fixtures;  ///< solid boxes in the world frame, inside or outside the workspace; not divided into
                              ///< cells

  [[nodiscard]] Status validate() const;
};

/// Changes made by one update.
struct ObstacleUpdate {
  std::size_t bricks{0};  ///< bricks of the map whose obstacle voxels differ
  std::size_t cells{0};   ///< cells that became obstacles or ceased to be obstacles
  double ms{0.0};
};

/// Spheres in the world frame, coordinate by coordinate; all four spans are equally long.
struct SphereSpans {
  std::span<const float> x_m;
  std::span<const float> y_m;
  std::span<const float> z_m;
  std::span<const float> radius_m;

  [[nodiscard]] bool same_length() const {
    return y_m.size() == x_m.size() && z_m.size() == x_m.size() && radius_m.size() == x_m.size();
  }
};

/// Obstacle cells (ObstacleCells) and fixtures for collision checks. Thesis §2.1. A sphere touches an obstacle when a
/// point of the obstacle's closed box lies in the closed sphere. The answer is exact, up to a slack of 1e-9 cells in
/// favour of touching, and independent of thread count and instruction set. A sphere with a coordinate or radius that
/// is not finite is never clear.
///
/// One writer (update); const use from many threads is safe. Copies are independent; about 10 bytes per cell.
class ObstacleMap {
 public:
  /// @return invalid_argument for a bad configuration, a map without a workspace, or one with too many cells.
  /// O(cells · cells in max_distance_m), milliseconds for a 3 m workspace.
  [[nodiscard]] static Result<ObstacleMap> create(const TsdfSnapshot& map, const ObstacleConfig& config,
                                                  const Executor& executor);

  /// Brings the obstacles up to date with the map; the result equals a new ObstacleMap to the bit. Keeps the snapshot
  /// until the next update, to find changes by what both share.
  /// @return invalid_argument, changing nothing, when voxel size or workspace differ from those of create(). O(sectors
  /// + bricks written since that hold an obstacle + rows of cells within max_distance_m of a change); about a
  /// millisecond after a view. The thread count never changes a bit of the result.
  /// millisecond after a view. The thread count never changes a bit of the result.
  [[nodiscard]] Result<ObstacleUpdate> update(const TsdfSnapshot& map, const Executor& executor);

  /// Tells whether the sphere touches nothing. One cell decides most cases, the cells within the sphere the others.
  [[nodiscard]] bool clear(const Eigen::Vector3d& center_world, double radius_m) const;
  /// Returns the index of the first sphere that is not clear, or their number when all are clear. Tests several at a
  /// time and stops there, so the most endangered spheres should come first.
  [[nodiscard]] std::size_t first_touching(const SphereSpans& spheres) const;

  /// Sets bit i of `out` when sphere i is not known to be clear. Looks at one cell per sphere, so it may be clear
  /// nevertheless; clear() decides. `out` has one word per 64 spheres, rounded up.
  void perhaps_touching(const SphereSpans& spheres, std::span<std::uint64_t> out) const;

  /// Computes for each sphere distance_bound_m of its centre minus its radius, up to rounding; never more than the true
  /// clearance. -∞ where a coordinate or radius is not finite. `out` has one entry per sphere.
  void clearance_bounds(const SphereSpans& spheres, std::span<float> out) const;

  /// Returns the distance of a point from the nearest obstacle, at most max_distance_m; 0 inside one. O(rows of cells
  /// within it).
  [[nodiscard]] double distance_m(const Eigen::Vector3d& p_world) const;
  /// Returns a lower bound of distance_m. In the workspace it is less by at most a cell's diagonal, or by that and half
  /// an edge where a fixture is nearest. Looks at one cell.
  [[nodiscard]] double distance_bound_m(const Eigen::Vector3d& p_world) const;

  [[nodiscard]] const ObstacleConfig& config() const { return config_; }
  [[nodiscard]] const ObstacleCells& cells() const { return *cells_; }
  [[nodiscard]] const ObstacleField& field() const { return *field_; }
  /// Returns the boxes of all obstacle cells in z-y-x order, then the fixtures.
  [[nodiscard]] std::vector<Box> boxes() const;

 private:
  /// Point relative to the field, in half cells.
  struct Place {
    Index3 cell;             ///< nearest cell
    double outside_squared;  ///< squared distance from the field; 0 inside
    double from_centre;      ///< distance from the cell's centre to the nearest point of the field
  };
  ObstacleMap(const TsdfConfig& map, ObstacleConfig config, ObstacleCells cells, int reach_cells,
              const Executor& executor);
  [[nodiscard]] Place place(const Eigen::Vector3d& p_world) const;
  [[nodiscard]] obstacle::FieldView view() const;
  [[nodiscard]] bool touches_cell(const Eigen::Vector3d& center_world, double radius_m) const;
  [[nodiscard]] bool touches_fixture(const Eigen::Vector3d& center_world, double radius_m) const;
  [[nodiscard]] double fixture_distance_m(const Eigen::Vector3d& p_world) const;

  ObstacleConfig config_;
  double voxel_size_m_;
  std::optional<Box> workspace_;
  Hidden<ObstacleCells> cells_;
  Hidden<ObstacleField> field_;
  Eigen::Vector3d origin_;  ///< lower corner of the cells
  double half_cells_per_m_;
  float batch_slack_;  ///< in half cells
  std::vector<std::array<float, 6>> float_fixtures_;
};

}  // namespace saccade
