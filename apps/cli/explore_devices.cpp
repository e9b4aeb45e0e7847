// SPDX-License-Identifier: Apache-2.0
#include "explore_devices.hpp"

#include "saccade/io/scene_yaml.hpp"
#include "saccade/io/urdf.hpp"

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
    SACCADE_TRY(SimulatedRobot robot, simulated_arm(*arm, subject.scene, options.run, options.arm));
    return std::unique_ptr<Robot>{std::make_unique<SimulatedRobot>(std::move(robot))};
  }
  if (!subject.rays) return std::unique_ptr<Robot>{std::make_unique<FreeRobot>()};
  SACCADE_TRY(FreeRobot robot, flying_camera(*subject.rays));
  return std::unique_ptr<Robot>{std::make_unique<FreeRobot>(std::move(robot))};
}

/// None without an arm.
Result<std::shared_ptr<const ArmSilhouette>> silhouette_of(const std::optional<ArmModel>& arm,
                                                           const PinholeCamera& camera) {
  std::shared_ptr<const ArmSilhouette> silhouette;
  if (!arm) return silhouette;
  auto made = ArmSilhouette::create(*arm, camera);
  if (!made) return made.error();
  silhouette = std::make_shared<const ArmSilhouette>(std::move(*made));
  return silhouette;
}

}  // namespace

Result<std::optional<ArmModel>> read_arm(const ExploreOptions& options) {
  if (!options.has_arm()) return std::optional<ArmModel>{};
  SACCADE_TRY(UrdfArm read, find_robot(options.robot));
  return std::optional{std::move(read.arm)};
}

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
                                            const std::optional<ArmModel>& arm, const Executor& executor) {
  SACCADE_TRY(std::unique_ptr<Robot> robot, open_robot(options, subject, arm));
  if (!options.camera_command.empty()) {
    ExternalCameraConfig config;
    config.command = options.camera_command;
    config.start_timeout_s = config.capture_timeout_s = options.process_timeout_s;
    SACCADE_TRY(ExternalCamera camera, ExternalCamera::start(config));
    SACCADE_TRY(auto silhouette, silhouette_of(arm, camera.camera()));
    return ExploreDevices{std::move(camera), std::move(robot), std::move(silhouette), executor};
  }
  SACCADE_TRY(SimulatedCamera camera, simulated_camera(*subject.rays, options.run));
  SACCADE_TRY(auto silhouette, silhouette_of(arm, camera.camera()));
  return ExploreDevices{std::move(camera), std::move(robot), std::move(silhouette), executor};
}

const PinholeCamera& ExploreDevices::camera() const {
  return std::visit([](const auto& camera) -> const PinholeCamera& { return camera.camera(); }, camera_);
}

Result<Frame> ExploreDevices::capture(const Pose& T_world_camera) {
  auto* simulated = std::get_if<SimulatedCamera>(&camera_);
  if (simulated == nullptr) return std::get<ExternalCamera>(camera_).capture(T_world_camera);
  const std::optional<Configuration> q = robot_->configuration();
  if (!silhouette_ || !q || !silhouette_->in_picture(*q)) return simulated->capture(T_world_camera, executor_);
  return simulated->capture(T_world_camera, silhouette_->depth(*q, executor_), executor_);
}

Result<Frame> ExploreDevices::observe(const Pose& T_world_camera) {
  SACCADE_TRY(Frame frame, capture(T_world_camera));
  if (const std::optional<Configuration> q = robot_->configuration(); silhouette_ && q) {
    SACCADE_TRY([[maybe_unused]] const std::size_t masked, silhouette_->mask(*q, frame.depth, executor_));
  }
  ++frames_;
  seen_.push_back(frame);
  return frame;
}

Status ExploreDevices::change_scene(const RayScene& scene, const SimulatedRunConfig& config) {
  SACCADE_EXPECTS(std::holds_alternative<SimulatedCamera>(camera_));
  SACCADE_TRY(SimulatedCamera camera, simulated_camera(scene, config));
  camera.resume_at(frames_);
  camera_ = std::move(camera);
  return {};
}

Status ExploreDevices::place_arm(const Configuration& q) {
  auto* arm = dynamic_cast<ArmRobot*>(robot_.get());
  if (arm == nullptr) return Error{Errc::invalid_argument, "there is no arm to be placed", "explore"};
  return arm->place(q);
}

void ExploreDevices::resume_at(std::size_t frames) {
  frames_ = frames;
  if (auto* simulated = std::get_if<SimulatedCamera>(&camera_)) simulated->resume_at(frames);
}

}  // namespace saccade::cli
