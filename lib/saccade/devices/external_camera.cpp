// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/external_camera.hpp"

#include <utility>
#include <vector>

#include "saccade/devices/internal/external_process.hpp"
#include "saccade/devices/internal/process_messages.hpp"

namespace saccade {

Status ExternalCameraConfig::validate() const {
  SACCADE_CHECK(validate_time_limit(start_timeout_s, "camera"));
  return validate_time_limit(capture_timeout_s, "camera");
}

ExternalCamera::ExternalCamera(ExternalCameraConfig config, std::unique_ptr<ExternalProcess> process,
                               ExternalCameraFormat format)
    : config_{std::move(config)}, process_{std::move(process)}, format_{format} {}
ExternalCamera::ExternalCamera(ExternalCamera&&) noexcept = default;
ExternalCamera& ExternalCamera::operator=(ExternalCamera&&) noexcept = default;
ExternalCamera::~ExternalCamera() = default;

Result<ExternalCamera> ExternalCamera::start(const ExternalCameraConfig& config) {
  SACCADE_CHECK(config.validate());
  SACCADE_TRY(std::unique_ptr<ExternalProcess> process, ExternalProcess::start("camera", config.command));
  const Request request{"hello", config.start_timeout_s};
  SACCADE_TRY(const std::string line, process->ask(request, hello_request("camera")));
  const auto format = parse_camera_hello(line);
  if (!format) return process->refused(request, format.error());
  return ExternalCamera{config, std::move(process), *format};
}

Result<Frame> ExternalCamera::capture(const Pose& T_world_camera) {
  const std::size_t number = asked_++;
  const Request request{"frame " + std::to_string(number), config_.capture_timeout_s};
  SACCADE_TRY(const std::string line, process_->ask(request, capture_request(number, T_world_camera)));
  const auto answer = parse_capture_answer(line, number, format_.frame_bytes());
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
