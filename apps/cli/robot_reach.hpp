// SPDX-License-Identifier: Apache-2.0
#pragma once
// saccade robot reach: where an arm can bring the camera, as a picture and a table.

#include <filesystem>
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
  ArmOptions arm{"comau_smart_six", {}, {}, false};
  std::string scene{"tabletop-1"};
  std::optional<Box> workspace;
  std::optional<double> height_m;
  std::optional<double> step_m;
  std::vector<double> radii_m{0.8};
  std::filesystem::path out;
  bool force{false};
};

/// What was asked, with everything that the options left open settled.
struct ReachTask {
  UrdfArm robot;
  InverseKinematics ik;
  std::string scene;
  std::vector<FixtureBox> fixtures;
  ReachMapConfig config;
};

/// Adds the subcommand to `saccade robot`.
void add_robot_reach(CLI::App& robot, const GlobalOptions& global, Action& action);

}  // namespace saccade::cli
