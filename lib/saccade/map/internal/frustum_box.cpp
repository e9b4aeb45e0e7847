// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/internal/frustum_box.hpp"

#include <Eigen/Geometry>

namespace saccade {

Result<IndexBox> sectors_in_frustum(const tsdf::FusionCamera& camera, const Pose& T_world_camera, double reach_m,
                                    double voxel_size_m) {
  constexpr double kRoundingM{1e-4};       // far above the rounding, far below a voxel
  constexpr double kMostSectors{1 << 24};  // limit per frame
  const Error too_many_voxels{
      Errc::invalid_argument,
      "too many voxels lie between the camera and what it sees; use a shorter range or larger voxels",
      {}};
  Eigen::Vector3d lo = T_world_camera.translation();
  Eigen::Vector3d hi = lo;
  for (const double u : {-0.5, camera.width - 0.5}) {
    for (const double v : {-0.5, camera.height - 0.5}) {
      const Eigen::Vector3d ray{(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0};
      const Eigen::Vector3d corner = T_world_camera * Eigen::Vector3d{ray * reach_m};
      if (!corner.allFinite()) return too_many_voxels;
      lo = lo.cwiseMin(corner);
      hi = hi.cwiseMax(corner);
    }
  }
  const double sector_m = kSectorVoxelEdge * voxel_size_m;
  const Eigen::Vector3d sectors = (hi - lo) / sector_m + Eigen::Vector3d::Ones();
  if (sectors.prod() > kMostSectors) return too_many_voxels;
  const Index3 first = voxel_at(lo - Eigen::Vector3d::Constant(kRoundingM), sector_m);
  const Index3 last = voxel_at(hi + Eigen::Vector3d::Constant(kRoundingM), sector_m);
  return IndexBox{first, last + Index3{1, 1, 1}};
}

}  // namespace saccade
