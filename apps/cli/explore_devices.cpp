// SPDX-License-Identifier: Apache-2.0
#include "explore_devices.hpp"

#include <algorithm>

#include "cell_options.hpp"
#include "rehearsal.hpp"
#include "robot_options.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

bool same_box(const Box& a, const Box& b) { return a.min == b.min && a.max == b.max; }

Result<std::unique_ptr<Robot>> open_robot(const ExploreOptions& options, const ExploreSetup& subject,
                                          const std::optional<ArmModel>& arm) {
  if (!options.robot_command.empty() && options.dry_run) return std::unique_ptr<Robot>{std::make_unique<FreeRobot>()};
  if (!options.robot_command.empty()) {
    SACCADE_TRY(std::unique_ptr<ProgramRobot> robot,
                ProgramRobot::start(program_config(options, options.robot_command, options.cell.robot)));
    return std::unique_ptr<Robot>{std::move(robot)};
  }
  if (arm) {
    std::shared_ptr<JointController> joints;
    if (!options.joints_command.empty()) {
      SACCADE_TRY(joints, ProgramJoints::start(joints_config(options, *arm)));
    }
    if (joints && options.dry_run) {  // the program is asked where they stand, and ends
      SACCADE_TRY(Configuration standing, joints->position());
      joints = std::make_shared<SimulatedJoints>(std::move(standing));
    }
    SACCADE_TRY(PlannedArm robot, planned_arm(*arm, subject.scene, options.run, options.arm, std::move(joints)));
    return std::unique_ptr<Robot>{std::make_unique<PlannedArm>(std::move(robot))};
  }
  if (!subject.rays) return std::unique_ptr<Robot>{std::make_unique<FreeRobot>()};
  SACCADE_TRY(FreeRobot robot, flying_camera(*subject.rays));
  return std::unique_ptr<Robot>{std::make_unique<FreeRobot>(std::move(robot))};
}

/// Where an arm holds its camera; nullopt for other robots.
std::optional<Pose> standing_pose(const Robot& robot) {
  const auto* arm = dynamic_cast<const PlannedArm*>(&robot);
  return arm != nullptr ? std::optional{arm->T_world_camera()} : std::nullopt;
}

}  // namespace

Result<std::optional<UrdfArm>> read_described_arm(const ExploreOptions& options) {
  if (!options.has_arm()) return std::optional<UrdfArm>{};
  SACCADE_TRY(UrdfArm read, find_robot(options.robot, options.arm_reading.urdf));
  if (options.speed) read.arm = slowed(read.arm, *options.speed);
  return std::optional{std::move(read)};
}

Result<std::optional<ArmModel>> read_arm(const ExploreOptions& options, ProgressBar* bar) {
  SACCADE_TRY(std::optional<UrdfArm> read, read_described_arm(options));
  if (!read) return std::optional<ArmModel>{};
  if (bar != nullptr) show_choices(*read, *bar);
  return std::optional{std::move(read->arm)};
}

Result<ExploreSetup> open_case(const ExploreOptions& options, const Executor& executor) {
  SACCADE_TRY(Scene scene, find_scene(options.scene, options.mesh));
  SACCADE_CHECK(check_workspace(scene, options.run.map().voxel_size_m));
  ExploreSetup subject{std::move(scene), std::nullopt, std::nullopt};
  if (!options.camera_command.empty() && subject.scene.objects.empty()) return subject;
  SACCADE_TRY(subject.rays, RayScene::build(subject.scene));
  const bool has_objects = std::any_of(subject.scene.objects.begin(), subject.scene.objects.end(),
                                       [](const SceneObject& object) { return !object.support; });
  if (options.camera_command.empty() && !has_objects && options.run.strategy.needs_truth) {
    return Error{Errc::invalid_argument,
                 "there is nothing but supports, and the strategy " + options.run.strategy.name +
                     " goes by the objects that it knows; choose another one",
                 subject.scene.name};
  }
  if (options.knows_truth() && has_objects) {
    SACCADE_TRY(subject.truth, GroundTruth::build(*subject.rays, kTruthSpacing_m, executor));
  }
  return subject;
}

Result<TsdfMap> map_to_begin_with(const ExploreOptions& options, const Scene& scene, const Executor& executor) {
  TsdfConfig config = options.run.map();
  config.workspace = scene.workspace;
  if (options.map.empty()) return TsdfMap::create(config);
  SACCADE_TRY(TsdfSnapshot saved, load_map(options.map, executor));
  const auto fail = [&](const std::string& what) { return Error{Errc::invalid_argument, what, options.map.string()}; };
  if (saved.config.voxel_size_m != config.voxel_size_m) {
    return fail("the map has voxels of " + fixed(1e3 * saved.config.voxel_size_m, 2) + " mm, not " +
                fixed(1e3 * config.voxel_size_m, 2) + "; give the same --voxel-size, in metres");
  }
  if (!saved.config.workspace) saved.config.workspace = config.workspace;
  if (!same_box(*saved.config.workspace, scene.workspace)) return fail("the map was made in another workspace");
  return TsdfMap{std::move(saved)};
}

Result<ExploreDevices> ExploreDevices::open(const ExploreOptions& options, const ExploreSetup& subject,
                                            const std::optional<ArmModel>& arm, const Executor& executor) {
  SACCADE_TRY(std::unique_ptr<Robot> robot, open_robot(options, subject, arm));
  const ArmModel* const own = arm ? &*arm : nullptr;
  if (options.camera_command.empty()) {
    SACCADE_TRY(SimulatedCamera camera, simulated_camera(*subject.rays, options.run));
    SACCADE_TRY(MaskedCamera carried, MaskedCamera::create(std::move(camera), std::move(robot), own, executor));
    return ExploreDevices{std::move(carried)};
  }
  SACCADE_TRY(ProgramCamera started,
              ProgramCamera::start(program_config(options, options.camera_command, options.cell.camera)));
  std::unique_ptr<Camera> camera = std::make_unique<ProgramCamera>(std::move(started));
  if (options.dry_run) {
    SACCADE_TRY(camera,
                rehearsal_camera(std::move(camera), subject.scene, options.cell.fixtures, standing_pose(*robot)));
  }
  SACCADE_TRY(MaskedCamera carried, MaskedCamera::create(std::move(camera), std::move(robot), own, executor));
  return ExploreDevices{std::move(carried)};
}

Result<bool> ExploreDevices::look_from_where_it_stands(TsdfMap& map, const Executor& executor) {
  const std::optional<Pose> T_world_camera = standing_pose(robot());
  if (!T_world_camera) return false;
  SACCADE_TRY(const Frame frame, camera_.capture(*T_world_camera));
  SACCADE_TRY([[maybe_unused]] const FusionStats fused,
              map.integrate(intrinsics(), frame.depth, frame.T_world_camera.value_or(*T_world_camera), executor,
                            frame.color ? &*frame.color : nullptr));
  return true;
}

Status ExploreDevices::change_scene(const RayScene& scene, const SimulatedRunConfig& config) {
  SACCADE_EXPECTS(camera_.simulated() != nullptr);
  SACCADE_TRY(SimulatedCamera camera, simulated_camera(scene, config));
  camera.resume_at(camera_.simulated()->frames());
  *camera_.simulated() = std::move(camera);
  return {};
}

Status ExploreDevices::place_arm(const Configuration& q) {
  auto* arm = dynamic_cast<PlannedArm*>(&camera_.robot());
  if (arm == nullptr) return Error{Errc::invalid_argument, "there is no arm to be placed", "explore"};
  return arm->place(q);
}

void ExploreDevices::resume_at(std::size_t frames) {
  if (SimulatedCamera* simulated = camera_.simulated()) simulated->resume_at(frames);
}

}  // namespace saccade::cli
