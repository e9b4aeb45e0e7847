// SPDX-License-Identifier: Apache-2.0
#pragma once
// The protocol of external cameras and robots, docs/processes.md: requests as text, answers from text and bytes.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/camera_source.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Version of the protocol: "saccade" in the first request and its answer.
constexpr int kProcessProtocol{1};
/// More is taken for a mistake: 16384×16384 pixels are 1 GiB.
constexpr std::size_t kMaxFrameBytes{std::size_t{1} << 28};

enum class ExternalDepth { float32_m, uint16_mm };
enum class ExternalColor { none, rgb8 };
inline constexpr auto kExternalDepthNames =
    make_names<ExternalDepth>({{ExternalDepth::float32_m, "float32_m"}, {ExternalDepth::uint16_mm, "uint16_mm"}});
inline constexpr auto kExternalColorNames =
    make_names<ExternalColor>({{ExternalColor::none, "none"}, {ExternalColor::rgb8, "rgb8"}});

/// What a camera says of itself.
struct ExternalCameraFormat {
  PinholeCamera camera;
  ExternalDepth depth{ExternalDepth::float32_m};
  ExternalColor color{ExternalColor::none};

  /// Of depth and colour together.
  [[nodiscard]] std::size_t frame_bytes() const;
};

struct CaptureAnswer {
  std::optional<Pose> T_world_camera;  ///< where the camera knows it better than the robot
  std::optional<double> time_s;
};

struct MoveAnswer {
  std::optional<Pose> T_world_camera;  ///< where the camera is now; nullopt: not reached
  std::string why;                     ///< it was not reached; may be empty
};

/// One line each, without its end.
[[nodiscard]] std::string hello_request(std::string_view role);
[[nodiscard]] std::string capture_request(std::size_t number, const Pose& T_world_camera);
[[nodiscard]] std::string move_request(std::size_t number, const Pose& T_world_camera);

/// Errors of all that follow: unavailable with the process' own words when it answers {"error": …}; corrupt_data for
/// what is no JSON object, lacks a key, or holds nonsense.
///
/// unsupported: another version of the protocol, a distorted camera; invalid_argument as PinholeCamera::validate().
[[nodiscard]] Result<ExternalCameraFormat> parse_camera_hello(std::string_view line);
[[nodiscard]] Status parse_robot_hello(std::string_view line);
/// size_mismatch unless it announces frame_bytes.
[[nodiscard]] Result<CaptureAnswer> parse_capture_answer(std::string_view line, std::size_t number,
                                                         std::size_t frame_bytes);
/// @param T_world_camera the pose that was asked for; where the camera is unless the answer says another.
[[nodiscard]] Result<MoveAnswer> parse_move_answer(std::string_view line, std::size_t number,
                                                   const Pose& T_world_camera);

/// Depth and colour of a frame. Depths that are no number or out of the camera's range become 0. Expects frame_bytes()
/// bytes. O(pixels).
[[nodiscard]] Frame decode_frame(const ExternalCameraFormat& format, std::span<const std::byte> bytes);

}  // namespace saccade
