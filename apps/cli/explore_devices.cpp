// SPDX-License-Identifier: Apache-2.0
#include "explore_devices.hpp"

#include <algorithm>

#include "saccade/arm/urdf.hpp"
#include "saccade/scene/scene_yaml.hpp"

namespace saccade::cli {
namespace {

Result<std::unique_ptr<Robot>> open_robot(const ExploreOptions& options, const ExploreCase& subject,
                                          const std::optional<ArmModel>& arm) {
  if (!options.robot_command.empty()) {
    ExternalRobotConfig config;
    config.command = options.robot_command;
    config.start_timeout_s = config.move_timeout_s = options.process_timeout_s;
    SACCADE_TRY(std::unique_ptr<ExternalRobot> robot, ExternalRobot::start(config));
    return std::unique_ptr<Robot>{std::move(robot)};
  }
  if (arm) {
    SACCADE_TRY(PlannedArm robot, simulated_arm(*arm, subject.scene, options.run, options.arm));
    return std::unique_ptr<Robot>{std::make_unique<PlannedArm>(std::move(robot))};
  }
  if (!subject.rays) return std::unique_ptr<Robot>{std::make_unique<FreeRobot>()};
  SACCADE_TRY(FreeRobot robot, flying_camera(*subject.rays));
  return std::unique_ptr<Robot>{std::make_unique<FreeRobot>(std::move(robot))};
}

}  // namespace

Result<std::optional<ArmModel>> read_arm(const ExploreOptions& options) {
  if (!options.has_arm()) return std::optional<ArmModel>{};
  SACCADE_TRY(UrdfArm read, find_robot(options.robot, options.arm_reading.urdf));
  return std::optional{std::move(read.arm)};
}

Result<ExploreCase> open_case(const ExploreOptions& options, const Executor& executor) {
  SACCADE_TRY(Scene scene, find_scene(options.scene));
  ExploreCase subject{std::move(scene), std::nullopt, std::nullopt};
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
  if (options.camera_command.empty() && has_objects) {
    SACCADE_TRY(subject.truth, Truth::build(*subject.rays, kTruthSpacing_m, executor));
  }
  return subject;
}

Result<ExploreDevices> ExploreDevices::open(const ExploreOptions& options, const ExploreCase& subject,
                                            const std::optional<ArmModel>& arm, const Executor& executor) {
  SACCADE_TRY(std::unique_ptr<Robot> robot, open_robot(options, subject, arm));
  const ArmModel* const own = arm ? &*arm : nullptr;
  if (options.camera_command.empty()) {
    SACCADE_TRY(SimulatedCamera camera, simulated_camera(*subject.rays, options.run));
    SACCADE_TRY(CarriedCamera carried, CarriedCamera::create(std::move(camera), std::move(robot), own, executor));
    return ExploreDevices{std::move(carried)};
  }
  ExternalCameraConfig config;
  config.command = options.camera_command;
  config.start_timeout_s = config.capture_timeout_s = options.process_timeout_s;
  SACCADE_TRY(ExternalCamera started, ExternalCamera::start(config));
  SACCADE_TRY(CarriedCamera carried, CarriedCamera::create(std::make_unique<ExternalCamera>(std::move(started)),
                                                           std::move(robot), own, executor));
  return ExploreDevices{std::move(carried)};
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
