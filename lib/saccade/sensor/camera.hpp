// SPDX-License-Identifier: Apache-2.0
#pragma once
// Camera: takes frames where it is moved to; FunctionCamera: one made of a function.

#include <functional>

#include "saccade/sensor/camera_source.hpp"

namespace saccade {

/// A depth camera that is asked for frames one by one. One caller at a time.
class Camera {
 public:
  virtual ~Camera() = default;
  [[nodiscard]] virtual const PinholeCamera& intrinsics() const = 0;
  /// @param T_world_camera where the robot says that the camera is; the frame may know better.
  [[nodiscard]] virtual Result<Frame> capture(const Pose& T_world_camera) = 0;
};

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
