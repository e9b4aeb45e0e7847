// SPDX-License-Identifier: Apache-2.0
#pragma once
// Frame: one image of a depth camera. CameraSource: a stream of frames. Camera: takes frames where it is moved to.
// OwnBody: the robot's body in the camera's image.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// One RGB-D frame; depth and colour share the camera.
struct Frame {
  std::size_t index{0};  ///< position in the source, counting skipped frames
  std::string name;      ///< name for messages (a file stem, a time stamp)
  std::optional<double> time_s;
  DepthImage depth;
  std::optional<ColorImage> color;
  std::optional<Pose> T_world_camera;  ///< known pose, where the source has one
};

/// A stream of frames from one camera. One caller at a time.
class CameraSource {
 public:
  virtual ~CameraSource() = default;
  [[nodiscard]] virtual const PinholeCamera& camera() const = 0;
  /// Returns the number of frames, where it is known beforehand.
  [[nodiscard]] virtual std::optional<std::size_t> size() const = 0;
  /// Returns the next frame; nullopt at the end. A missing or corrupt frame is an error that names it. The source has
  /// then moved past it, and the next call delivers the following frame.
  [[nodiscard]] virtual Result<std::optional<Frame>> next() = 0;
};

/// A depth camera that takes frames on request. One caller at a time.
class Camera {
 public:
  virtual ~Camera() = default;
  [[nodiscard]] virtual const PinholeCamera& intrinsics() const = 0;
  /// @param T_world_camera the camera's pose as reported by the robot; the frame may hold a better one.
  [[nodiscard]] virtual Result<Frame> capture(const Pose& T_world_camera) = 0;
};

/// Returns the depth of a robot's own body along z in metres, as the camera that it holds sees it from a pose; 0 where
/// there is none. The image has the camera's size. nullopt: no part of the body is in the image.
using OwnBody = std::function<std::optional<DepthImage>(const Pose& T_world_camera)>;

/// Calls a function for each frame; without one it sees nothing: no pixel has a return.
class FunctionCamera final : public Camera {
 public:
  using Capture = std::function<Result<Frame>(const Pose& T_world_camera)>;
  explicit FunctionCamera(const PinholeCamera& intrinsics, Capture capture = {})
      : intrinsics_{intrinsics}, capture_{std::move(capture)} {}
  [[nodiscard]] const PinholeCamera& intrinsics() const override { return intrinsics_; }
  [[nodiscard]] Result<Frame> capture(const Pose& T_world_camera) override {
    if (capture_) return capture_(T_world_camera);
    Frame frame;
    frame.depth = DepthImage{intrinsics_.width, intrinsics_.height};
    return frame;
  }

 private:
  PinholeCamera intrinsics_;
  Capture capture_;
};

}  // namespace saccade
