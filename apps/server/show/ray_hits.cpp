// SPDX-License-Identifier: Apache-2.0
#include "server/show/ray_hits.hpp"

#include <optional>

#include "saccade/map/ray_walk.hpp"
#include "saccade/views/sensor_rays.hpp"

namespace saccade::server {
namespace {

std::optional<RayHit> hit_of(const TsdfSnapshot& map, const Region& region, const PinholeCamera& sensor,
                             const LatticeRay& ray) {
  std::optional<RayHit> hit;
  const RaySpan whole{kRayStart, after_depth(static_cast<float>(sensor.max_range_m))};
  walk_cells<kVoxelLevel>(ray, whole, [&](const Index3& voxel, const RaySpan& in_voxel) {
    const VoxelState state = map.grid.state(voxel);
    if (state == VoxelState::empty) return false;
    const Eigen::Vector3d center = voxel_center(voxel, map.config.voxel_size_m);
    if (map.config.workspace && !contains(*map.config.workspace, center)) return false;
    const bool has_entered = in_voxel.enter.axis != kRayStart.axis;  // the ray does not enter the camera's own voxel
    if (!has_entered || in_voxel.enter.t < static_cast<float>(sensor.min_range_m)) return true;
    const RayEnd unknown = contains(region, center) ? RayEnd::gained : RayEnd::unknown;
    hit = RayHit{center.cast<float>(), state == VoxelState::occupied ? RayEnd::surface : unknown};
    return true;
  });
  return hit;
}

}  // namespace

std::vector<RayHit> ray_hits(const TsdfSnapshot& map, const Region& region, const PinholeCamera& sensor,
                             const Pose& T_world_camera, const Executor& executor) {
  const SensorRays rays = sensor_rays(T_world_camera, map.config.voxel_size_m);
  std::vector<std::vector<RayHit>> of_row(static_cast<std::size_t>(sensor.height));
  executor.parallel_for(of_row.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      for (int u = 0; u < sensor.width; ++u) {
        const LatticeRay ray = pixel_ray(rays, sensor, u, static_cast<int>(v));
        if (const auto hit = hit_of(map, region, sensor, ray)) of_row[v].push_back(*hit);
      }
    }
  });
  std::vector<RayHit> hits;
  for (const std::vector<RayHit>& row : of_row) hits.insert(hits.end(), row.begin(), row.end());
  return hits;
}

}  // namespace saccade::server
