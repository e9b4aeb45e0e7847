// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/projection_gain.hpp"

#include <limits>

namespace saccade {
namespace {

/// Centres of the unknown voxels that count and have an empty and an occupied one among their 26 neighbours.
std::vector<Eigen::Vector3d> frontier_centers(const BaselineScene& scene, const Executor& executor) {
  const StateVolume& volume = scene.volume;
  const IndexBox inner = scene.counted.intersection(volume.box().grown(-1));
  if (inner.empty()) return {};
  const Neighbours around{volume};
  std::vector<std::vector<Eigen::Vector3d>> layers(static_cast<std::size_t>(inner.size().z));
  executor.parallel_for(layers.size(), 1, [&](std::size_t layer, std::size_t) {
    inner.layer(layer).for_each([&](const Index3& voxel) {
      const std::size_t i = volume.index(voxel);
      if (volume[i] != VoxelState::unknown) return;
      bool empty = false;
      bool occupied = false;
      for (const std::ptrdiff_t offset : around.offsets) {
        const VoxelState state = volume[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + offset)];
        empty = empty || state == VoxelState::empty;
        occupied = occupied || state == VoxelState::occupied;
      }
      if (empty && occupied && scene.counts(voxel)) {
        layers[layer].push_back(voxel_center(voxel, volume.voxel_size_m()));
      }
    });
  });
  std::vector<Eigen::Vector3d> centers;
  for (const std::vector<Eigen::Vector3d>& part : layers) centers.insert(centers.end(), part.begin(), part.end());
  return centers;
}

/// An image of what is nearest.
struct DepthBuffer {
  int width;
  std::vector<double> depth_m;
  std::vector<std::uint8_t> is_frontier;

  void draw(const std::vector<Ellipsoid>& ellipsoids, bool frontier, const Pose& T_camera_world,
            const PinholeCamera& camera) {
    for (const Ellipsoid& ellipsoid : ellipsoids) {
      const auto ellipse = projected(ellipsoid, T_camera_world, camera);
      if (!ellipse) continue;
      for (int v = ellipse->v_begin; v < ellipse->v_end; ++v) {
        for (int u = ellipse->u_begin; u < ellipse->u_end; ++u) {
          const auto pixel = static_cast<std::size_t>(v * width + u);
          if (ellipse->depth_m >= depth_m[pixel] || !ellipse->contains(u, v)) continue;
          depth_m[pixel] = ellipse->depth_m;
          is_frontier[pixel] = frontier ? 1 : 0;
        }
      }
    }
  }
};

}  // namespace

SceneEllipsoids scene_ellipsoids(const BaselineScene& scene, const Executor& executor) {
  const double voxel_m = scene.volume.voxel_size_m();
  std::vector<Eigen::Vector3d> occupied;
  for (const SurfaceVoxel& surface : surface_voxels(scene.volume, scene.counted, executor)) {
    occupied.push_back(voxel_center(scene.volume.voxel(surface.voxel), voxel_m));
  }
  return {fitted_ellipsoids(frontier_centers(scene, executor), kClusterCell_m, voxel_m),
          fitted_ellipsoids(occupied, kClusterCell_m, voxel_m)};
}

double frontier_pixels(const SceneEllipsoids& ellipsoids, const Pose& T_world_camera, const PinholeCamera& camera) {
  const auto pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  DepthBuffer image{camera.width, std::vector<double>(pixels, std::numeric_limits<double>::infinity()),
                    std::vector<std::uint8_t>(pixels, 0)};
  const Pose T_camera_world = T_world_camera.inverse(Eigen::Isometry);
  image.draw(ellipsoids.occupied, false, T_camera_world, camera);
  image.draw(ellipsoids.frontier, true, T_camera_world, camera);
  double count{0.0};
  for (const std::uint8_t frontier : image.is_frontier) count += static_cast<double>(frontier);
  return count;
}

ProjectionGain::ProjectionGain(const BaselineGainConfig& config)
    : config_{config}, camera_{sampled_camera(config)} {
  SACCADE_EXPECTS(config.validate().ok());
}

Result<std::vector<double>> ProjectionGain::evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) {
  SACCADE_CHECK(check_poses(T_world_camera));
  SACCADE_TRY(const BaselineScene scene, read_baseline_scene(context, region, config_.object_margin_m));
  std::vector<double> gains(T_world_camera.size(), 0.0);
  if (scene.counted.empty()) return gains;
  const SceneEllipsoids ellipsoids = scene_ellipsoids(scene, context.executor);
  context.executor.parallel_for(gains.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      gains[i] = frontier_pixels(ellipsoids, T_world_camera[i], camera_);
    }
  });
  return gains;
}

std::shared_ptr<Gain> projection_gain(const BaselineGainConfig& config) {
  return std::make_shared<ProjectionGain>(config);
}

}  // namespace saccade
