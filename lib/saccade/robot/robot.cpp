// SPDX-License-Identifier: Apache-2.0
#include "saccade/robot/robot.hpp"

namespace saccade {

Result<bool> FreeRobot::move_to(const Pose& T_world_camera) {
  T_world_camera_ = T_world_camera;
  return true;
}

}  // namespace saccade
