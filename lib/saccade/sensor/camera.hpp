// SPDX-License-Identifier: Apache-2.0
#pragma once
// Frame: what a depth camera delivers; CameraSource: where frames come from; Camera: takes frames where it is moved to;
// OwnBody: what a robot would see of itself.

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
  std::size_t index{0};  ///< position in the source, counting the skipped ones
  std::string name;      ///< what a person would call it, for messages (a file stem, a time stamp)
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
  /// Frames in all, where that is known beforehand.
  [[nodiscard]] virtual std::optional<std::size_t> size() const = 0;
  /// The next frame; nullopt at the end. A frame that is missing or corrupt is an error that names it; the source has
  /// then moved past it, and the next call delivers the following frame.
  [[nodiscard]] virtual Result<std::optional<Frame>> next() = 0;
};

/// A depth camera that is asked for frames one by one. One caller at a time.
class Camera {
 public:
  virtual ~Camera() = default;
  [[nodiscard]] virtual const PinholeCamera& intrinsics() const = 0;
  /// @param T_world_camera where the robot says that the camera is; the frame may know better.
  [[nodiscard]] virtual Result<Frame> capture(const Pose& T_world_camera) = 0;
};

/// Returns the depth of a robot's own body along z, metres, as the camera that it holds sees it from a pose; 0: none
/// there. nullopt: no body is in the picture.
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
