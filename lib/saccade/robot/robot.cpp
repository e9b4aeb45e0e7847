// SPDX-License-Identifier: Apache-2.0
#include "saccade/robot/robot.hpp"

namespace saccade {

Result<std::optional<Pose>> FreeRobot::move_to(const Pose& T_world_camera) {
  if (allowed_ && !allowed_(T_world_camera.translation())) return std::optional<Pose>{};
  T_world_camera_ = T_world_camera;
  return std::optional{T_world_camera};
}

}  // namespace saccade
