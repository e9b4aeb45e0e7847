// SPDX-License-Identifier: Apache-2.0
#pragma once
// saccade robot reach: where an arm can bring the camera, as a picture and a table.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "robot_options.hpp"
#include "saccade/arm/reach_map.hpp"
#include "saccade/core/region.hpp"
#include "saccade/scene/scene.hpp"

namespace saccade::cli {

struct ReachOptions {
  ArmOptions arm{.robot = "comau_smart_six"};
  std::string scene{"tabletop-1"};
  std::optional<Box> workspace;
  std::optional<double> height_m;
  std::optional<double> step_m;
  std::vector<double> radii_m{0.8};
};

/// Request with the defaults filled in for the options that were not given.
struct ReachTask {
  UrdfArm robot;
  InverseKinematics ik;
  std::string scene;
  std::vector<FixtureBox> fixtures;
  ReachMapConfig config;
};

[[nodiscard]] std::unique_ptr<Command> make_robot_reach();

}  // namespace saccade::cli
