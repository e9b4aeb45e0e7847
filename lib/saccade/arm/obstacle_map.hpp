// SPDX-License-Identifier: Apache-2.0
#pragma once
// ObstacleMap: what an arm must not touch, by the map and by declared fixtures, and how far spheres are from it.

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
  double cell_size_m{0.04};        ///< thesis §2.1; the nearest whole number of voxels is taken
  bool unknown_is_obstacle{true};  ///< thesis §2.1; else only occupied voxels are
  double max_distance_m{0.5};      ///< distances are followed up to here
  std::vector<Box> fixtures;  ///< solid boxes in the world frame, inside or outside the workspace; not cut into cells

  [[nodiscard]] Status validate() const;
};

/// What one update changed.
struct ObstacleUpdate {
  std::size_t bricks{0};  ///< bricks of the map whose obstacle voxels differ
  std::size_t cells{0};   ///< cells that became obstacles or ceased to be
  double ms{0.0};
};

/// Spheres in the world frame, coordinate by coordinate; all four of the same length.
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
/// point of the obstacle's closed box lies in the closed sphere; the answer is exact, up to a slack of 1e-9 cells on
/// the side of touching, and does not depend on thread count or instruction set. Where a coordinate or radius is not
/// finite, a sphere is not clear.
///
/// One writer (update); const use from many threads is safe. Copies are independent; about 10 bytes per cell.
class ObstacleMap {
 public:
  /// @return invalid_argument for a bad configuration, a map without a workspace, or one with too many cells.
  /// O(cells · cells in max_distance_m), milliseconds for a 3 m workspace.
  [[nodiscard]] static Result<ObstacleMap> create(const TsdfSnapshot& map, const ObstacleConfig& config,
                                                  const Executor& executor);

  /// Follows the map to its present state; afterwards equal to one made anew, to the bit. It keeps the snapshot until
  /// the next update, to see by what both share where the map changed.
  /// @return invalid_argument, changing nothing, when voxel size or workspace are not those of create().
  /// O(sectors + bricks written since that hold an obstacle + rows of cells within max_distance_m of a change); about a
  /// millisecond after a view. The thread count never changes a bit of the result.
  [[nodiscard]] Result<ObstacleUpdate> update(const TsdfSnapshot& map, const Executor& executor);

  /// Whether the sphere touches nothing. A look at one cell decides for most; else the cells within the sphere do.
  [[nodiscard]] bool clear(const Eigen::Vector3d& center_world, double radius_m) const;
  /// The first sphere that is not clear; their number when all are. Several at a time; those after it are not asked
  /// about, so the most endangered ones belong in front.
  [[nodiscard]] std::size_t first_touching(const SphereSpans& spheres) const;

  /// Bit i of `out`: sphere i is not known to be clear. One look at one cell for each, so it may be clear nevertheless;
  /// clear() knows. `out` has a word for every 64 spheres begun.
  void perhaps_touching(const SphereSpans& spheres, std::span<std::uint64_t> out) const;

  /// For each sphere distance_bound_m of its centre less its radius, but for rounding; never more than the true
  /// clearance. -∞ where a coordinate or radius is not finite. `out` has the spheres' number.
  void clearance_bounds(const SphereSpans& spheres, std::span<float> out) const;

  /// Distance of a point from the nearest obstacle, at most max_distance_m; 0 inside one. O(rows of cells within it).
  [[nodiscard]] double distance_m(const Eigen::Vector3d& p_world) const;
  /// At most distance_m, and in the workspace less by no more than a cell's diagonal, or where a fixture is nearest,
  /// that and half an edge. One look at one cell.
  [[nodiscard]] double distance_bound_m(const Eigen::Vector3d& p_world) const;

  [[nodiscard]] const ObstacleConfig& config() const { return config_; }
  [[nodiscard]] const ObstacleCells& cells() const { return *cells_; }
  [[nodiscard]] const ObstacleField& field() const { return *field_; }
  /// Boxes of all obstacle cells in z-y-x order, then the fixtures.
  [[nodiscard]] std::vector<Box> boxes() const;

 private:
  /// A point relative to the field, in half cells.
  struct Place {
    Index3 cell;             ///< the nearest one
    double outside_squared;  ///< from the field; 0 inside
    double from_centre;      ///< from the cell's centre to the nearest point of the field
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
