// SPDX-License-Identifier: Apache-2.0
#pragma once
// TimedFrame: a frame taken while the camera moves, which waits until it is known where the camera was.

#include <optional>
#include <utility>

#include "saccade/robot/robot.hpp"
#include "saccade/sensor/camera.hpp"

namespace saccade {

/// Camera and robot tell times on clocks of their own.
class TimedFrame {
 public:
  /// @param offset_s added to the camera's times for those of the robot
  explicit TimedFrame(double offset_s) : offset_s_{offset_s} {}

  /// Takes a frame over, unless it or the robot has no clock, or the camera knows its pose itself.
  /// @param asked where the robot was when the frame was asked for
  [[nodiscard]] bool hold(Frame& frame, const CameraSample& asked);
  [[nodiscard]] bool holds() const { return frame_.has_value(); }
  /// Where the camera was when it took the frame, once the robot has come that far; nullopt: not yet, or no frame.
  [[nodiscard]] std::optional<CameraSample> reached(const CameraSample& now);
  [[nodiscard]] Frame take() { return *std::exchange(frame_, std::nullopt); }

 private:
  double offset_s_;
  std::optional<Frame> frame_;
  CameraSample before_;  ///< the last sample from before the frame
};

}  // namespace saccade
