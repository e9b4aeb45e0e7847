// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include "saccade/devices/internal/process_messages.hpp"
#include "saccade/devices/internal/program.hpp"
#include "saccade/devices/programs.hpp"

namespace saccade {

Status ProgramConfig::validate(const char* role) const {
  SACCADE_CHECK(validate_time_limit(start_timeout_s, role));
  return validate_time_limit(timeout_s, role);
}

ProgramCamera::ProgramCamera(ProgramConfig config, std::unique_ptr<ExternalProcess> process, ProgramCameraFormat format)
    : config_{std::move(config)}, process_{std::move(process)}, format_{format} {}
ProgramCamera::ProgramCamera(ProgramCamera&&) noexcept = default;
ProgramCamera& ProgramCamera::operator=(ProgramCamera&&) noexcept = default;
ProgramCamera::~ProgramCamera() = default;

Result<ProgramCamera> ProgramCamera::start(const ProgramConfig& config) {
  SACCADE_TRY(auto started,
              start_program<ProgramCameraFormat>("camera", config, hello_request("camera"), parse_camera_hello));
  return ProgramCamera{config, std::move(started.process), started.answer};
}

Result<Frame> ProgramCamera::capture(const Pose& T_world_camera) {
  const std::size_t number = asked_++;
  const Request request{"frame " + std::to_string(number), config_.timeout_s};
  SACCADE_TRY(const std::string line, process_->ask(request, capture_request(number, T_world_camera)));
  const auto answer = parse_capture_answer(line, number, format_.frame_bytes(), T_world_camera);
  if (!answer) return process_->refused(request, answer.error());
  std::vector<std::byte> bytes(format_.frame_bytes());
  SACCADE_CHECK(process_->read_bytes(request, bytes));
  Frame frame = decode_frame(format_, bytes);
  frame.index = number;
  frame.name = request.name();
  frame.time_s = answer->time_s;
  frame.T_world_camera = answer->T_world_camera.value_or(T_world_camera);
  return frame;
}

}  // namespace saccade
