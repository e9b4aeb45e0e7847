// SPDX-License-Identifier: Apache-2.0
#pragma once
// Robot: what moves the camera; FreeRobot: a camera that flies.

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Carries the camera. One caller at a time.
class Robot {
 public:
  virtual ~Robot() = default;
  /// Brings the camera to a pose. False when it cannot be reached; nothing has moved then. An Error means that the
  /// robot itself failed, and its pose is not known.
  [[nodiscard]] virtual Result<bool> move_to(const Pose& T_world_camera) = 0;
};

/// Reaches every pose, at once.
class FreeRobot final : public Robot {
 public:
  [[nodiscard]] Result<bool> move_to(const Pose& T_world_camera) override;
  [[nodiscard]] const Pose& T_world_camera() const { return T_world_camera_; }

 private:
  Pose T_world_camera_{Pose::Identity()};
};

}  // namespace saccade
