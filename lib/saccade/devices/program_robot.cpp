// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "saccade/devices/internal/process_messages.hpp"
#include "saccade/devices/internal/program.hpp"
#include "saccade/devices/programs.hpp"

namespace saccade {

ProgramRobot::ProgramRobot(ProgramConfig config, std::unique_ptr<ExternalProcess> process)
    : config_{std::move(config)}, process_{std::move(process)} {}
ProgramRobot::~ProgramRobot() = default;

Result<std::unique_ptr<ProgramRobot>> ProgramRobot::start(const ProgramConfig& config) {
  SACCADE_TRY(auto started, start_program<Ready>("robot", config, hello_request("robot"), parse_ready));
  return std::unique_ptr<ProgramRobot>{new ProgramRobot{config, std::move(started.process)}};
}

Result<PlannedMotion> ProgramRobot::plan(std::span<const Pose> T_world_camera, MotionKind /*way*/) {
  SACCADE_EXPECTS(!T_world_camera.empty());
  return PlannedMotion{Motion{0, T_world_camera.front(), {}}, std::nullopt, ""};
}

Result<std::optional<Arrival>> ProgramRobot::execute(const Motion& motion, const MotionObserver& on_way) {
  const std::size_t number = asked_++;
  const Request request{"move " + std::to_string(number), config_.timeout_s};
  why_not_reached_.clear();
  SACCADE_TRY(const std::string line, process_->ask(request, move_request(number, motion.T_world_camera)));
  auto answer = parse_move_answer(line, number, motion.T_world_camera);
  if (!answer) return process_->refused(request, answer.error());
  if (!answer->T_world_camera) {
    why_not_reached_ = std::move(answer->why);
    return std::optional<Arrival>{};
  }
  if (on_way) static_cast<void>(on_way({0.0, *answer->T_world_camera}));
  return std::optional{Arrival{*answer->T_world_camera, 0.0}};
}

}  // namespace saccade
