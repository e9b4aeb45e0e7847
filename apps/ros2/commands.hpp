// SPDX-License-Identifier: Apache-2.0
#pragma once
// Commands of saccade-ros2. Each runs until its input ends, returns its exit status, and throws error texts.

#include "devices/camera_program.hpp"

namespace saccade::ros2 {

int run_camera_command(const devices::Options& options);
int run_joints(const devices::Options& options);
int run_hand(const devices::Options& options);
int run_publish(const devices::Options& options);

}  // namespace saccade::ros2
