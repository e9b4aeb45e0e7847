// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/tile_depths.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {

TileDepths::TileDepths(const SurfaceTable& surface, const PinholeCamera& camera, const Pose& T_world_camera,
                       double voxel_size_m)
    : width_{(camera.width + kTilePx - 1) / kTilePx},
      height_{(camera.height + kTilePx - 1) / kTilePx},
      tiles_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {
  const Pose T_camera_world = T_world_camera.inverse();
  // Cells of a brick reach from its first voxel's centre to one voxel beyond its last: 8 voxels, shifted by a half.
  const double half_m = 0.5 * kBrickEdge * voxel_size_m;
  const double radius_m = half_m * std::sqrt(3.0) * 1.001;
  surface.for_each_brick([&](const Index3& brick) {
    const Index3 lo = brick * kBrickEdge;
    const Eigen::Vector3d center_world = voxel_center(lo, voxel_size_m) + Eigen::Vector3d::Constant(half_m);
    const Eigen::Vector3d c = T_camera_world * center_world;
    if (c.z() + radius_m <= 0.0 || c.z() - radius_m > camera.max_range_m) return;
    const Interval interval{static_cast<float>(std::max(0.0, c.z() - radius_m)), static_cast<float>(c.z() + radius_m)};
    const double nearest_z = c.z() - radius_m;
    if (nearest_z < 0.05) {  // around or beside the camera: every tile
      widen(0, 0, width_ - 1, height_ - 1, interval);
      return;
    }
    // The ball's box, projected: its extreme image coordinates occur at its nearest or farthest depth.
    const auto extent = [&](double center, double focal, double principal) {
      const double lo_side = center - radius_m;
      const double hi_side = center + radius_m;
      const double lo_px = focal * lo_side / (lo_side < 0.0 ? nearest_z : c.z() + radius_m) + principal;
      const double hi_px = focal * hi_side / (hi_side > 0.0 ? nearest_z : c.z() + radius_m) + principal;
      return std::pair{lo_px - 1.0, hi_px + 1.0};
    };
    const auto [u0, u1] = extent(c.x(), camera.fx, camera.cx);
    const auto [v0, v1] = extent(c.y(), camera.fy, camera.cy);
    if (u1 < 0.0 || v1 < 0.0 || u0 > camera.width || v0 > camera.height) return;
    widen(static_cast<int>(std::max(0.0, u0)) / kTilePx, static_cast<int>(std::max(0.0, v0)) / kTilePx,
          static_cast<int>(std::min(camera.width - 1.0, u1)) / kTilePx,
          static_cast<int>(std::min(camera.height - 1.0, v1)) / kTilePx, interval);
  });
}

void TileDepths::widen(int tile_u0, int tile_v0, int tile_u1, int tile_v1, const Interval& interval) {
  for (int v = tile_v0; v <= tile_v1; ++v) {
    for (int u = tile_u0; u <= tile_u1; ++u) {
      Interval& tile =
          tiles_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u)];
      const bool empty = tile.farthest_m < tile.nearest_m;
      tile.nearest_m = empty ? interval.nearest_m : std::min(tile.nearest_m, interval.nearest_m);
      tile.farthest_m = empty ? interval.farthest_m : std::max(tile.farthest_m, interval.farthest_m);
    }
  }
}

}  // namespace saccade
