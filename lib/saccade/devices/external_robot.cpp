// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/external_robot.hpp"

#include <utility>

#include "saccade/devices/internal/external_process.hpp"
#include "saccade/devices/internal/process_messages.hpp"

namespace saccade {

Status ExternalRobotConfig::validate() const {
  SACCADE_CHECK(validate_time_limit(start_timeout_s, "robot"));
  return validate_time_limit(move_timeout_s, "robot");
}

ExternalRobot::ExternalRobot(ExternalRobotConfig config, std::unique_ptr<ExternalProcess> process)
    : config_{std::move(config)}, process_{std::move(process)} {}
ExternalRobot::~ExternalRobot() = default;

Result<std::unique_ptr<ExternalRobot>> ExternalRobot::start(const ExternalRobotConfig& config) {
  SACCADE_CHECK(config.validate());
  SACCADE_TRY(std::unique_ptr<ExternalProcess> process, ExternalProcess::start("robot", config.command));
  const Request request{"hello", config.start_timeout_s};
  SACCADE_TRY(const std::string line, process->ask(request, hello_request("robot")));
  const Status ready = parse_robot_hello(line);
  if (!ready.ok()) return process->refused(request, ready.error());
  return std::unique_ptr<ExternalRobot>{new ExternalRobot{config, std::move(process)}};
}

Result<PlannedMotion> ExternalRobot::plan(std::span<const Pose> T_world_camera, Way /*way*/) {
  SACCADE_EXPECTS(!T_world_camera.empty());
  return PlannedMotion{Motion{0, T_world_camera.front(), {}}, std::nullopt, ""};
}

Result<std::optional<Arrival>> ExternalRobot::execute(const Motion& motion, const OnWay& on_way) {
  const std::size_t number = asked_++;
  const Request request{"move " + std::to_string(number), config_.move_timeout_s};
  why_not_reached_.clear();
  SACCADE_TRY(const std::string line, process_->ask(request, move_request(number, motion.T_world_camera)));
  auto answer = parse_move_answer(line, number, motion.T_world_camera);
  if (!answer) return process_->refused(request, answer.error());
  if (!answer->T_world_camera) {
    why_not_reached_ = std::move(answer->why);
    return std::optional<Arrival>{};
  }
  if (on_way) on_way({0.0, *answer->T_world_camera});
  return std::optional{Arrival{*answer->T_world_camera, 0.0}};
}

}  // namespace saccade
