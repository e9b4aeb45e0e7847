// SPDX-License-Identifier: Apache-2.0
#include "thesis/update_task.hpp"

#include <algorithm>
#include <numbers>

#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "saccade/views/view_gain.hpp"
#include "saccade/views/view_sphere.hpp"

namespace saccade::thesis {
namespace {

constexpr std::string_view kStage{"mapping the table"};
constexpr const char* kScene{"bottle-before"};
constexpr int kVolumeBricks{64};  // 512 voxels
constexpr double kRegionRadius_m{0.2};
/// Half the height of a bottle above the box on the right.
const Eigen::Vector3d kPoi{0.24, 0.12, 0.26};
const Eigen::Vector3d kTable{0.0, 0.0, 0.1};

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

/// Where the table is seen from before the user's task: all around, far enough to see the space of the views, too.
std::vector<Pose> scan_poses() {
  ViewSphereConfig config;
  config.radii_m = {1.8};
  config.longitude_step_rad = radians(45.0);
  config.latitude_min_rad = radians(25.0);
  config.latitude_max_rad = radians(65.0);
  config.latitude_step_rad = radians(40.0);
  config.roll_step_rad = radians(360.0);
  return poses_of(view_sphere(kTable, config).value());
}

IndexBox volume_around(const Eigen::Vector3d& center, double voxel_size_m) {
  const Index3 middle = parent(voxel_at(center, voxel_size_m));
  constexpr std::int32_t kHalf{kVolumeBricks / 2};
  return {middle - Index3{kHalf, kHalf, kHalf}, middle + Index3{kHalf, kHalf, kHalf}};
}

Box box_of(const IndexBox& bricks, double voxel_size_m) {
  const auto corner = [voxel_size_m](const Index3& brick) {
    return Eigen::Vector3d{kBrickEdge * voxel_size_m * Eigen::Vector3d(brick.x, brick.y, brick.z)};
  };
  return {corner(bricks.lo), corner(bricks.hi)};
}

}  // namespace

std::vector<Pose> UpdateTask::some_poses(std::size_t count) const {
  if (count == 0 || count >= view_sphere.size()) return view_sphere;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) poses.push_back(view_sphere[(2 * i + 1) * view_sphere.size() / (2 * count)]);
  return poses;
}

Result<UpdateTask> make_update_task(std::uint64_t seed, const Executor& executor, const Progress& progress) {
  SimulatedRunConfig config;
  config.seed = seed;
  SACCADE_TRY(Scene scene, find_scene(kScene));
  SACCADE_TRY(const RayScene rays, RayScene::build(std::move(scene)));
  SACCADE_TRY(SimulatedCamera camera, simulated_camera(rays, config));

  UpdateTask task;
  task.scene = kScene;
  task.region = Sphere{kPoi, kRegionRadius_m};
  task.volume_bricks = volume_around(kPoi, config.voxel_size_m);
  task.sensor = GainConfig{}.sensor;
  task.view_sphere = poses_of(view_sphere(kPoi).value());
  task.camera = camera.camera();
  TsdfConfig map_config = config.map();
  map_config.workspace = box_of(task.volume_bricks, config.voxel_size_m);
  SACCADE_TRY(TsdfMap map, TsdfMap::create(map_config));
  const std::vector<Pose> poses = scan_poses();
  for (const Pose& pose : poses) {
    if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", std::string{kStage}};
    progress.report(kStage, task.frames, poses.size());
    const Frame frame = camera.capture(pose, executor);
    SACCADE_TRY(const FusionStats fused, map.integrate(task.camera, frame.depth, pose, executor));
    if (fused.valid_pixels > 0) ++task.frames;
  }
  SACCADE_CHECK(map.forget(task.region));
  task.map = map.snapshot();
  const Pose T_world_next = look_at(kPoi + Eigen::Vector3d{-0.5, -0.5, 0.4}, kPoi);
  task.next_frame = camera.capture(T_world_next, executor);
  return task;
}

}  // namespace saccade::thesis
