// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/surface_edge_gain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "saccade/views/internal/check_finite.hpp"

namespace saccade {
namespace {

constexpr std::int32_t kUnknownReach_vox{
    2};  // largest distance, along an axis, of the unknown voxel that belongs to a frontier

/// Step to a neighbour within the density's radius.
struct Step {
  std::ptrdiff_t offset{0};
  Eigen::Vector3f step_vox;
};

std::vector<Step> steps_within(const StateVolume& volume, double radius_vox) {
  std::vector<Step> steps;
  const auto reach = static_cast<std::int32_t>(radius_vox);
  IndexBox{{-reach, -reach, -reach}, {reach + 1, reach + 1, reach + 1}}.for_each([&](const Index3& i) {
    const Eigen::Vector3f step{static_cast<float>(i.x), static_cast<float>(i.y), static_cast<float>(i.z)};
    if (static_cast<double>(step.norm()) > radius_vox) return;
    steps.push_back({i.z * volume.layer() + i.y * volume.row() + i.x, step});
  });
  std::stable_sort(steps.begin(), steps.end(),
                   [](const Step& a, const Step& b) { return a.step_vox.squaredNorm() < b.step_vox.squaredNorm(); });
  return steps;
}

std::size_t moved(std::size_t index, std::ptrdiff_t offset) {
  return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(index) + offset);
}

bool has_empty_face(const StateVolume& volume, std::size_t voxel) {
  for (const std::ptrdiff_t stride : {std::ptrdiff_t{1}, volume.row(), volume.layer()}) {
    if (volume[moved(voxel, stride)] == VoxelState::empty || volume[moved(voxel, -stride)] == VoxelState::empty)
      return true;
  }
  return false;
}

/// Surface around a voxel.
struct SurfacePatch {
  double density{0.0};  ///< relative to a plane
  Eigen::Vector3f normal{Eigen::Vector3f::Zero()};
  Eigen::Vector3f mean_vox{Eigen::Vector3f::Zero()};  ///< centre of its voxels, relative to the middle one
};

}  // namespace

std::vector<FrontierPoint> frontier_points(const BaselineScene& scene, const Executor& executor) {
  const StateVolume& volume = scene.volume;
  constexpr auto kReach = static_cast<std::int32_t>(kDensityRadius_vox);
  const IndexBox inner = volume.box().grown(-kReach - 1);
  const std::vector<SurfaceVoxel> surface =
      surface_voxels(volume, scene.counted.grown(kReach).intersection(volume.box()), executor);
  std::vector<std::uint32_t> at(volume.size(), 0);  // number of the surface voxel + 1
  for (std::size_t i = 0; i < surface.size(); ++i) at[surface[i].voxel] = static_cast<std::uint32_t>(i + 1);
  const std::vector<Step> steps = steps_within(volume, kDensityRadius_vox);
  constexpr double kPlane_vox = std::numbers::pi * kDensityRadius_vox * kDensityRadius_vox;

  std::vector<SurfacePatch> patches(surface.size());
  executor.parallel_for(surface.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!inner.contains(volume.voxel(surface[i].voxel))) {
        patches[i].density = 1.0;  // at the border of the workspace, where surface cannot continue
        continue;
      }
      float area_vox{0.0F};
      for (const Step& step : steps) {
        const std::uint32_t other = at[moved(surface[i].voxel, step.offset)];
        if (other == 0) continue;
        const SurfaceVoxel& near = surface[other - 1];
        area_vox += near.area_vox;
        patches[i].normal += near.area_vox * near.normal;
        patches[i].mean_vox += near.area_vox * step.step_vox;
      }
      patches[i].mean_vox /= area_vox;
      patches[i].density = static_cast<double>(area_vox) / kPlane_vox;
    }
  });
  std::vector<FrontierPoint> points;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const SurfacePatch& patch = patches[i];
    const Index3 voxel = volume.voxel(surface[i].voxel);
    if (patch.density >= kCoreDensity || !scene.counts(voxel)) continue;
    const bool beside_core = std::any_of(steps.begin(), steps.end(), [&](const Step& step) {
      const std::uint32_t other = at[moved(surface[i].voxel, step.offset)];
      return other != 0 && patches[other - 1].density >= kCoreDensity;
    });
    if (!beside_core) continue;
    const auto unknown = std::find_if(steps.begin(), steps.end(), [&](const Step& step) {
      const std::size_t other = moved(surface[i].voxel, step.offset);
      return step.step_vox.cwiseAbs().maxCoeff() <= static_cast<float>(kUnknownReach_vox) &&
             volume[other] == VoxelState::unknown && has_empty_face(volume, other);
    });
    if (unknown == steps.end() || patch.normal.norm() < 1e-3F) continue;
    const Eigen::Vector3f normal = patch.normal.normalized();
    Eigen::Vector3f outward = -patch.mean_vox + patch.mean_vox.dot(normal) * normal;
    if (outward.norm() > 1e-3F) outward.normalize();
    points.push_back({surface[i].voxel, static_cast<std::uint32_t>(moved(surface[i].voxel, unknown->offset)),
                      (normal + outward).normalized()});
  }
  return points;
}

SurfaceEdgeGain::SurfaceEdgeGain(const BaselineGainConfig& config)
    : config_{config}, camera_{widened_vertically(config.sensor, config.tilt_rad)} {
  SACCADE_EXPECTS(config.validate().ok());
}

Result<std::vector<double>> SurfaceEdgeGain::evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                      std::span<const Pose> T_world_camera) {
  SACCADE_CHECK(check_finite(T_world_camera, "baseline gain"));
  SACCADE_TRY(const BaselineScene scene, read_baseline_scene(context, region, config_.object_margin_m));
  std::vector<double> gains(T_world_camera.size(), 0.0);
  if (scene.counted.empty()) return gains;
  const StateVolume& volume = scene.volume;
  const std::vector<FrontierPoint> points = frontier_points(scene, context.executor);
  const std::vector<std::size_t> starts = starts_of_centers(T_world_camera);
  const double through_m = 1.5 * volume.voxel_size_m();
  context.executor.parallel_for(starts.size() - 1, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Eigen::Vector3d center = T_world_camera[starts[s]].translation();
      if (scene.is_blocked(center)) continue;
      std::vector<Eigen::Vector3d> visible;
      for (const FrontierPoint& point : points) {
        const Eigen::Vector3d p = voxel_center(volume.voxel(point.unknown), volume.voxel_size_m());
        const Eigen::Vector3d sight = center - p;
        if (point.facing.cast<double>().dot(sight) < kFrontierCosine * sight.norm()) continue;
        if (volume.is_visible(point.unknown, center, through_m)) visible.push_back(p);
      }
      for (std::size_t i = starts[s]; i < starts[s + 1]; ++i) {
        const Pose T_camera_world = T_world_camera[i].inverse(Eigen::Isometry);
        gains[i] = static_cast<double>(std::count_if(visible.begin(), visible.end(), [&](const Eigen::Vector3d& p) {
          return is_in_image(camera_, T_camera_world * p);
        }));
      }
    }
  });
  return gains;
}

std::shared_ptr<Gain> surface_edge_gain(const BaselineGainConfig& config) {
  return std::make_shared<SurfaceEdgeGain>(config);
}

}  // namespace saccade
