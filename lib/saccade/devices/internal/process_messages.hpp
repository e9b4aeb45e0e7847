// SPDX-License-Identifier: Apache-2.0
#pragma once
// Protocol of external cameras and robots, docs/guides/processes.md: requests as text, answers from text and bytes.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"
#include "saccade/devices/programs.hpp"
#include "saccade/sensor/camera.hpp"

namespace saccade {

/// Version of the protocol: "saccade" in the first request and its answer.
constexpr int kProcessProtocol{1};
/// Limit of a frame; more is taken for a mistake: 16384×16384 pixels are 1 GiB.
constexpr std::size_t kMaxFrameBytes{std::size_t{1} << 28};

/// Answer to hello of a program without a description.
struct Ready {};

struct CaptureAnswer {
  std::optional<Pose> T_world_camera;  ///< set where the camera knows it better than the robot
  std::optional<double> time_s;
};

struct MoveAnswer {
  std::optional<Pose> T_world_camera;  ///< current pose of the camera; nullopt: not reached
  std::string why;                     ///< why it was not reached; may be empty
};

/// Requests of one line each, without its end.
[[nodiscard]] std::string hello_request(std::string_view role);
[[nodiscard]] std::string capture_request(std::size_t number, const Pose& T_world_camera);
[[nodiscard]] std::string move_request(std::size_t number, const Pose& T_world_camera);

/// Returns the object in a line. Errors of this and of all that follow: unavailable with the process' own words when it
/// answers {"error": …}; corrupt_data for text that is not a JSON object, lacks a key, or holds nonsense.
[[nodiscard]] Result<nlohmann::json> parse_answer(std::string_view line);
/// Answers unsupported for another version of the protocol or a distorted camera; invalid_argument as
/// PinholeCamera::validate().
[[nodiscard]] Result<ProgramCameraFormat> parse_camera_hello(std::string_view line);
[[nodiscard]] Result<Ready> parse_ready(std::string_view line);
/// Answers size_mismatch unless it announces frame_bytes. A pose farther than kMaxPoseError_m from the given one is an
/// error.
[[nodiscard]] Result<CaptureAnswer> parse_capture_answer(std::string_view line, std::size_t number,
                                                         std::size_t frame_bytes, const Pose& T_world_camera);
/// @param T_world_camera the requested pose, which is the result unless the answer gives another; that is an error when
/// it is farther than kMaxPoseError_m.
[[nodiscard]] Result<MoveAnswer> parse_move_answer(std::string_view line, std::size_t number,
                                                   const Pose& T_world_camera);

/// Decodes depth and colour of a frame. Depths that are NaN or out of the camera's range become 0. Expects
/// frame_bytes() bytes. O(pixels).
[[nodiscard]] Frame decode_frame(const ProgramCameraFormat& format, std::span<const std::byte> bytes);

}  // namespace saccade
