// SPDX-License-Identifier: Apache-2.0
// Devices of a ROS 2 robot for Saccade, over DDS (docs/guides/ros2-robot.md). No installation of ROS is needed.
//
//   saccade-ros2 camera TOPIC [--info TOPIC] [--rectified] [--min-range M] [--max-range M] [--skip FRAMES]
//                             [--wait S] [--timeout S] [--reliable]
//   saccade-ros2 joints TOPIC [--states TOPIC] [--wait S] [--timeout S] [--arrived RAD] [--stop-time S]
//   saccade-ros2 hand FRAME [--reference FRAME] [--timeout S]
//   saccade-ros2 publish
//
// camera: depth images (sensor_msgs/Image) as a camera. joints: an arm behind a joint_trajectory_controller, which
// takes trajectories on TOPIC. hand: where FRAME is, from /tf and /tf_static. publish: messages from standard input.
// ROS_DOMAIN_ID and ROS_LOCALHOST_ONLY count as they do for every node.
#include <iostream>
#include <map>

#include "commands.hpp"

int main(int argc, char** argv) {
  using namespace saccade;
  const std::map<std::string, int (*)(const devices::Options&)> commands{{"camera", ros2::run_camera_command},
                                                                         {"joints", ros2::run_joints},
                                                                         {"hand", ros2::run_hand},
                                                                         {"publish", ros2::run_publish}};
  try {
    const auto command = commands.find(argc > 1 ? argv[1] : "");
    if (command == commands.end()) {
      throw std::runtime_error{"which device? saccade-ros2 camera TOPIC, joints TOPIC, hand FRAME, or publish"};
    }
    return command->second(devices::Options{argc - 1, argv + 1, {"--rectified", "--reliable"}});
  } catch (const std::exception& e) {
    std::cerr << "saccade-ros2: " << e.what() << '\n';
    return 1;
  }
}
