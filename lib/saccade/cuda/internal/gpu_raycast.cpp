// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/internal/gpu_raycast.hpp"

#include <algorithm>
#include <vector>

namespace saccade::internal::cuda {
namespace {

SurfaceArguments surface_arguments(const TsdfConfig& config, const PinholeCamera& camera, const Pose& T_world_camera) {
  SurfaceArguments a{};
  const Eigen::Vector3d origin = T_world_camera.translation() / config.voxel_size_m - Eigen::Vector3d::Constant(0.5);
  a.origin = lattice_point(origin.x(), origin.y(), origin.z());
  const Eigen::Matrix3d per_cell = T_world_camera.linear() / config.voxel_size_m;
  const Eigen::Matrix3f R_camera_world = T_world_camera.linear().transpose().cast<float>();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      a.per_cell[row][column] = per_cell(row, column);
      a.R_camera_world[row][column] = R_camera_world(row, column);
    }
  }
  a.width = static_cast<std::uint32_t>(camera.width);
  a.height = static_cast<std::uint32_t>(camera.height);
  a.min_range_m = static_cast<float>(camera.min_range_m);
  a.max_range_m = static_cast<float>(camera.max_range_m);
  return a;
}

}  // namespace

Result<SurfaceView> GpuRaycast::cast(const TsdfConfig& config, const PinholeCamera& camera, const Pose& T_world_camera,
                                     BrickStore& bricks) {
  SACCADE_CHECK(camera.validate());
  if (const auto checked = pose_from_matrix(T_world_camera.matrix()); !checked) return checked.error();
  SurfaceView view;
  view.depth = DepthImage{camera.width, camera.height};
  view.normals = Image<Eigen::Vector3f>{camera.width, camera.height, Eigen::Vector3f::Zero()};
  SurfaceArguments a = surface_arguments(config, camera, T_world_camera);
  a.map = bricks.view();
  if (a.map.bricks.count() == 0) return view;

  std::vector<double> coordinates;
  for (int u = 0; u < camera.width; ++u) coordinates.push_back(camera.ray(u, 0.0).x());
  for (int v = 0; v < camera.height; ++v) coordinates.push_back(camera.ray(0.0, v).y());
  SACCADE_CHECK(coordinates_.assign(coordinates));
  a.ray_x = coordinates_.data();
  a.ray_y = coordinates_.data() + camera.width;
  SACCADE_TRY(a.marks, bricks.mark_surface());
  SACCADE_CHECK(depths_m_.reserve(view.depth.size()));
  SACCADE_CHECK(normals_.reserve(3 * view.depth.size()));
  a.depths_m = depths_m_.data();
  a.normals = normals_.data();
  const std::size_t tiles = std::size_t{(a.width + CastSurfaceRays::kColumns - 1) / CastSurfaceRays::kColumns} *
                            ((a.height + CastSurfaceRays::kRows - 1) / CastSurfaceRays::kRows);
  SACCADE_CHECK(launch<CastSurfaceRays>(compute_, tiles, a));
  SACCADE_CHECK(depths_m_.read({view.depth.data(), view.depth.size()}));
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  SACCADE_CHECK(normals_.read({view.normals.data()->data(), 3 * view.normals.size()}));
  return view;
}

void GpuRaycast::free_buffers() noexcept {
  coordinates_.free();
  depths_m_.free();
  normals_.free();
}

}  // namespace saccade::internal::cuda
