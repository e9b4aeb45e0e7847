// SPDX-License-Identifier: Apache-2.0
// Feeds the answers of external cameras and robots: the first line as every kind of answer, what follows as pixels.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "saccade/devices/internal/joint_messages.hpp"
#include "saccade/devices/internal/process_messages.hpp"
#include "saccade/io/files/text_scan.hpp"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

/// Pixels of a camera that said what it is; missing ones are 0.
void decode(const saccade::ProgramCameraFormat& format, std::string_view pixels) {
  constexpr std::size_t kMostBytes{1 << 16};
  require(format.camera.validate().ok() && format.frame_bytes() <= saccade::kMaxFrameBytes);
  if (format.frame_bytes() > kMostBytes) return;
  std::vector<std::byte> bytes(format.frame_bytes());
  for (std::size_t i = 0; i < bytes.size() && i < pixels.size(); ++i) bytes[i] = static_cast<std::byte>(pixels[i]);
  const saccade::Frame frame = saccade::decode_frame(format, bytes);
  require(frame.depth.width() == format.camera.width && frame.depth.height() == format.camera.height);
  for (const float depth : frame.depth.pixels()) {
    require(std::isfinite(depth) && std::abs(static_cast<double>(depth)) <= 1.000001 * format.camera.max_range_m);
  }
}

void require_one_line(std::string_view text) {
  for (const char c : text) require(static_cast<unsigned char>(c) >= 0x20);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  if (const auto format = saccade::parse_camera_hello(line)) {
    decode(*format, text.substr(std::min(end + 1, text.size())));
  } else {
    require_one_line(saccade::readable(format.error().message, size + 400));
  }
  static_cast<void>(saccade::parse_ready(line));
  static_cast<void>(saccade::parse_joint_answer(line, 6));
  static_cast<void>(saccade::parse_sample_answer(line, 0));
  if (const auto capture = saccade::parse_capture_answer(line, 0, 16, saccade::Pose::Identity())) {
    if (capture->T_world_camera) require(capture->T_world_camera->matrix().allFinite());
  }
  if (const auto move = saccade::parse_move_answer(line, 0, saccade::Pose::Identity())) {
    require_one_line(move->why);
    if (move->T_world_camera) require(move->T_world_camera->matrix().allFinite());
  }
  require_one_line(saccade::last_lines(text));
  return 0;
}
