// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/surfel_surface.hpp"

#include <vector>

#include "saccade/surfel/surfel_points.hpp"

namespace saccade {
namespace {

PointImage points_of_surfels(const SurfelMap& map, const PinholeCamera& camera, const Pose& T_world_camera,
                             const Executor& executor, float min_weight) {
  std::vector<Eigen::Vector3f> positions_m, normals;
  std::vector<float> radii_m;
  for (const SurfelDisc& disc : map.discs) {
    if (disc.weight < min_weight) continue;
    positions_m.push_back(disc.position_m);
    normals.push_back(disc.normal);
    radii_m.push_back(disc.radius_m);
  }
  const SurfelView view = view_surfels({positions_m, normals, radii_m}, camera, T_world_camera, executor);
  const Eigen::Matrix3f R_camera_world = T_world_camera.linear().transpose().cast<float>();
  PointImage points{Image<float>{camera.width, camera.height}, Image<float>{camera.width, camera.height},
                    Image<float>{camera.width, camera.height}, Image<float>{camera.width, camera.height}};
  constexpr std::size_t kRows{16};
  executor.parallel_for(static_cast<std::size_t>(camera.height), kRows, [&](std::size_t begin, std::size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const SurfelId id = view.seen(u, v);
        const float z = view.depth(u, v);
        if (id == kNoSurfel || z < static_cast<float>(camera.min_range_m)) continue;
        const Eigen::Vector3f n = R_camera_world * normals[id];
        points.z(u, v) = z;
        points.nx(u, v) = n.x();
        points.ny(u, v) = n.y();
        points.nz(u, v) = n.z();
      }
    }
  });
  return points;
}

}  // namespace

SurfaceAt surface_of_surfels(const SurfelMap& map, const PinholeCamera& camera, const Executor& executor,
                             float min_weight) {
  return [&map, camera, &executor, min_weight](const Pose& T_world_camera) -> Result<PointImage> {
    return points_of_surfels(map, camera, T_world_camera, executor, min_weight);
  };
}

}  // namespace saccade
