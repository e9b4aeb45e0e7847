// SPDX-License-Identifier: Apache-2.0
#include "explore_devices.hpp"

#include "saccade/io/scene_yaml.hpp"

namespace saccade::cli {
namespace {

Result<std::unique_ptr<Robot>> open_robot(const ExploreOptions& options, const ExploreCase& subject) {
  if (!options.robot_command.empty()) {
    ExternalRobotConfig config;
    config.command = options.robot_command;
    config.start_timeout_s = config.move_timeout_s = options.process_timeout_s;
    SACCADE_TRY(std::unique_ptr<ExternalRobot> robot, ExternalRobot::start(config));
    return std::unique_ptr<Robot>{std::move(robot)};
  }
  if (!subject.rays) return std::unique_ptr<Robot>{std::make_unique<FreeRobot>()};
  SACCADE_TRY(FreeRobot robot, flying_camera(*subject.rays));
  return std::unique_ptr<Robot>{std::make_unique<FreeRobot>(std::move(robot))};
}

}  // namespace

Result<ExploreCase> open_case(const ExploreOptions& options, const Executor& executor) {
  SACCADE_TRY(Scene scene, find_scene(options.scene));
  ExploreCase subject{std::move(scene), std::nullopt, std::nullopt};
  if (!options.camera_command.empty() && subject.scene.objects.empty()) return subject;
  SACCADE_TRY(subject.rays, RayScene::build(subject.scene));
  if (options.camera_command.empty()) {
    SACCADE_TRY(subject.truth, Truth::build(*subject.rays, kTruthSpacing_m, executor));
  }
  return subject;
}

Result<ExploreDevices> ExploreDevices::open(const ExploreOptions& options, const ExploreCase& subject,
                                            const Executor& executor) {
  SACCADE_TRY(std::unique_ptr<Robot> robot, open_robot(options, subject));
  if (!options.camera_command.empty()) {
    ExternalCameraConfig config;
    config.command = options.camera_command;
    config.start_timeout_s = config.capture_timeout_s = options.process_timeout_s;
    SACCADE_TRY(ExternalCamera camera, ExternalCamera::start(config));
    return ExploreDevices{std::move(camera), std::move(robot), executor};
  }
  SACCADE_TRY(SimulatedCamera camera, simulated_camera(*subject.rays, options.run));
  return ExploreDevices{std::move(camera), std::move(robot), executor};
}

const PinholeCamera& ExploreDevices::camera() const {
  return std::visit([](const auto& camera) -> const PinholeCamera& { return camera.camera(); }, camera_);
}

Result<Frame> ExploreDevices::observe(const Pose& T_world_camera) {
  auto* simulated = std::get_if<SimulatedCamera>(&camera_);
  auto frame = simulated != nullptr ? Result<Frame>{simulated->capture(T_world_camera, executor_)}
                                    : std::get<ExternalCamera>(camera_).capture(T_world_camera);
  if (frame) {
    ++frames_;
    seen_.push_back(*frame);
  }
  return frame;
}

void ExploreDevices::resume_at(std::size_t frames) {
  frames_ = frames;
  if (auto* simulated = std::get_if<SimulatedCamera>(&camera_)) simulated->resume_at(frames);
}

}  // namespace saccade::cli
