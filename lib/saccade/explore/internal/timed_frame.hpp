// SPDX-License-Identifier: Apache-2.0
#pragma once
// TimedFrame: a frame taken during a motion, which waits until the camera's pose at that time is known.

#include <optional>
#include <utility>

#include "saccade/robot/robot.hpp"
#include "saccade/sensor/camera.hpp"

namespace saccade {

/// Frame in waiting. Camera and robot have separate clocks.
class TimedFrame {
 public:
  /// @param offset_s added to the camera's times to get the robot's
  explicit TimedFrame(double offset_s) : offset_s_{offset_s} {}

  /// Takes a frame, unless it or the robot has no clock, or the camera knows its own pose.
  /// @param asked the robot's pose when the frame was requested
  [[nodiscard]] bool hold(Frame& frame, const MotionSample& asked);
  [[nodiscard]] bool holds() const { return frame_.has_value(); }
  /// Returns the camera's pose at the frame's time, once the robot has come that far; nullopt: not yet, or no frame.
  [[nodiscard]] std::optional<MotionSample> reached(const MotionSample& now);
  [[nodiscard]] Frame take() { return *std::exchange(frame_, std::nullopt); }

 private:
  double offset_s_;
  std::optional<Frame> frame_;
  MotionSample before_;  ///< the last sample from before the frame
};

}  // namespace saccade
