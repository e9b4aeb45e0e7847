// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExternalCamera: a depth camera behind a program of the user's, docs/processes.md.

#include <memory>
#include <string>

#include "saccade/core/names.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

class ExternalProcess;

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

struct ExternalCameraConfig {
  std::string command;           ///< as a shell would run it
  double start_timeout_s{30.0};  ///< until it has said what it is
  double capture_timeout_s{10.0};

  [[nodiscard]] Status validate() const;
};

/// One caller at a time. Destroying it ends the program, as ExternalProcess does.
class ExternalCamera final : public Camera {
 public:
  /// Starts the program and asks what it is. unavailable: it reports an error itself; else the errors of
  /// ExternalProcess and parse_camera_hello(). Each names the command and quotes what the program wrote to stderr.
  [[nodiscard]] static Result<ExternalCamera> start(const ExternalCameraConfig& config);
  ExternalCamera(ExternalCamera&&) noexcept;
  ExternalCamera& operator=(ExternalCamera&&) noexcept;
  ~ExternalCamera() override;

  [[nodiscard]] const PinholeCamera& intrinsics() const override { return format_.camera; }
  [[nodiscard]] const ExternalCameraFormat& format() const { return format_; }

  /// Takes one frame. Its T_world_camera is the one given, or the camera's own where that knows better; its index
  /// counts from 0.
  /// @param T_world_camera where the robot says the camera is
  /// @return unavailable: the camera reports an error, and may be asked again. Any other error is final.
  [[nodiscard]] Result<Frame> capture(const Pose& T_world_camera) override;

 private:
  ExternalCamera(ExternalCameraConfig config, std::unique_ptr<ExternalProcess> process, ExternalCameraFormat format);

  ExternalCameraConfig config_;
  std::unique_ptr<ExternalProcess> process_;
  ExternalCameraFormat format_;
  std::size_t asked_{0};
};

}  // namespace saccade
