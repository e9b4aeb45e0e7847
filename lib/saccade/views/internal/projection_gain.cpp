// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/projection_gain.hpp"

#include <algorithm>

#include "saccade/views/internal/check_finite.hpp"

namespace saccade {
namespace {

/// Returns the centres of counted unknown voxels with an empty and an occupied one among their 26 neighbours.
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

struct Outline {
  Ellipse ellipse;
  bool is_frontier{false};
};

void add_outlines(const std::vector<Ellipsoid>& ellipsoids, bool is_frontier, const Pose& T_camera_world,
                  const PinholeCamera& camera, std::vector<Outline>& outlines) {
  for (const Ellipsoid& ellipsoid : ellipsoids) {
    if (const auto ellipse = projected(ellipsoid, T_camera_world, camera)) outlines.push_back({*ellipse, is_frontier});
  }
}

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
  const Pose T_camera_world = T_world_camera.inverse(Eigen::Isometry);
  std::vector<Outline> outlines;
  add_outlines(ellipsoids.occupied, false, T_camera_world, camera, outlines);
  add_outlines(ellipsoids.frontier, true, T_camera_world, camera, outlines);
  std::stable_sort(outlines.begin(), outlines.end(),
                   [](const Outline& a, const Outline& b) { return a.ellipse.depth_m < b.ellipse.depth_m; });
  const auto pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  std::vector<double> weights(pixels, 1.0);  // 0 where the nearest frontier was met
  double area_px{0.0};
  for (const Outline& outline : outlines) {  // nearest first
    const Ellipse& ellipse = outline.ellipse;
    for (int v = ellipse.v_begin; v < ellipse.v_end; ++v) {
      for (int u = ellipse.u_begin; u < ellipse.u_end; ++u) {
        if (!ellipse.contains(u, v)) continue;
        double& weight = weights[static_cast<std::size_t>(v * camera.width + u)];
        if (outline.is_frontier) area_px += weight;
        weight *= outline.is_frontier ? 0.0 : kOccludedWeight;
      }
    }
  }
  return area_px;
}

ProjectionGain::ProjectionGain(const BaselineGainConfig& config) : config_{config}, camera_{sampled_camera(config)} {
  SACCADE_EXPECTS(config.validate().ok());
}

Result<std::vector<double>> ProjectionGain::evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) {
  SACCADE_CHECK(check_finite(T_world_camera, "baseline gain"));
  SACCADE_TRY(const BaselineScene scene, read_baseline_scene(context, region, config_.object_margin_m));
  std::vector<double> gains(T_world_camera.size(), 0.0);
  if (scene.counted.empty()) return gains;
  const SceneEllipsoids ellipsoids = scene_ellipsoids(scene, context.executor);
  context.executor.parallel_for(gains.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (scene.is_blocked(T_world_camera[i].translation())) continue;
      gains[i] = frontier_pixels(ellipsoids, T_world_camera[i], camera_);
    }
  });
  return gains;
}

std::shared_ptr<Gain> projection_gain(const BaselineGainConfig& config) {
  return std::make_shared<ProjectionGain>(config);
}

}  // namespace saccade
