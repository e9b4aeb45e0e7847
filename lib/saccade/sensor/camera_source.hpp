// SPDX-License-Identifier: Apache-2.0
#pragma once
// Frame: what a depth camera delivers; CameraSource: where frames come from.

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

}  // namespace saccade
