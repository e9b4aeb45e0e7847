// SPDX-License-Identifier: Apache-2.0
// saccade-ros1 NODE …: Saccade's nodes for ROS 1.

#include <cstdio>
#include <cstring>
#include <exception>

#include "subcommands.hpp"

namespace {

struct Subcommand {
  const char* name;
  const char* what;
  int (*run)(int argc, char** argv);
};

constexpr Subcommand kSubcommands[] = {
    {"kinfu", "tracks and fuses depth images; answers commands and requests", run_kinfu},
    {"surfel_next_best_view", "evaluates view poses against clouds of surfels", run_surfel_next_best_view},
    {"basic_next_best_view", "ranks view poses around points of interest", run_basic_next_best_view},
    {"camera", "a camera's topic as a device of Saccade's (ros:TOPIC in a cell)", run_camera_device},
    {"joints", "a FollowJointTrajectory action as the joints of an arm (ros:ACTION in a cell)", run_joints_device},
    {"hand", "a frame of TF as a hand (ros:FRAME in a cell)", run_hand_device},
    {"publish", "publishes messages that come on standard input (saccade explore --publish ros)", run_publish},
};

int usage(std::FILE* file, int status) {
  std::fputs("usage: saccade-ros1 NODE [NAME:=VALUE …]\n\n", file);
  for (const Subcommand& subcommand : kSubcommands) std::fprintf(file, "  %-24s%s\n", subcommand.name, subcommand.what);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return usage(stderr, 2);
  if (std::strcmp(argv[1], "--help") == 0) return usage(stdout, 0);
  for (const Subcommand& subcommand : kSubcommands) {
    if (std::strcmp(argv[1], subcommand.name) != 0) continue;
    try {
      return subcommand.run(argc - 1, argv + 1);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "saccade-ros1 %s: %s\n", argv[1], error.what());
      return 1;
    }
  }
  std::fprintf(stderr, "saccade-ros1: there is no node '%s'\n", argv[1]);
  return usage(stderr, 2);
}
