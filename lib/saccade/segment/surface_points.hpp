// SPDX-License-Identifier: Apache-2.0
#pragma once
// surface_points: the surface of a map as a point cloud. SurfaceExtraction: this cloud brick by brick.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/map/voxel_block.hpp"

namespace saccade {

/// Returns one point per surface voxel: per cell between eight neighbouring voxel centres, all known, at least one of
/// them occupied and one empty (the cells of marching cubes). Unknown space bounds no surface.
///
/// A point lies at the mean of the zero crossings on the cell's edges, so that the points of a plane lie in it. Its
/// normal is the TSDF's gradient (thesis eq. 3.3 with six neighbours, eq. 3.4), the mean of those at the eight voxels,
/// one-sided next to an unknown voxel; of unit length, towards the empty side; zero where the gradient vanishes. Its
/// colour is the mean of those voxels that have one, grey where none has; no colours if no point has one.
/// @param min_weight  voxels observed less often count as unknown; 0 is taken as 1.
/// @return world frame, metres; by bricks in z-y-x order, then by cells in z-y-x order. An empty map: no points.
/// O(bricks near the surface). The thread count never changes a bit of the result.
[[nodiscard]] PointCloud surface_points(const TsdfSnapshot& map, const Executor& executor,
                                        std::uint16_t min_weight = 1);

/// Extraction of one brick's points after the other. One per thread; borrows the map, which must not be written
/// meanwhile.
class SurfaceExtraction {
 public:
  SurfaceExtraction(const SectorTable& table, double voxel_size_m, std::uint16_t min_weight);

  struct Point {
    Index3 cell;  ///< the voxel at its lower corner
    Eigen::Vector3f position_m;
    Eigen::Vector3f normal;
    Eigen::Vector3f color;
    bool colored{false};
  };
  /// Returns the points of cells whose lower corner lies in the brick; valid until the next call.
  [[nodiscard]] const std::vector<Point>& points_of(const Index3& brick);

 private:
  void add_point(const Index3& brick, const Index3& local);
  void add_color(const Index3& cell, Point& point) const;

  const SectorTable* table_;
  double voxel_size_m_;
  std::uint16_t min_weight_;
  VoxelBlock block_;
  bool has_colors_{false};  ///< whether a brick that the block reads has colours
  std::vector<Point> points_;
};

}  // namespace saccade
