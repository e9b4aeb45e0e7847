// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExploreOptions: what `saccade explore` is told.

#include <filesystem>
#include <memory>
#include <string>

#include "command.hpp"
#include "options.hpp"
#include "saccade/explore/simulated_run.hpp"

namespace saccade::cli {

struct ExploreOptions {
  std::string scene;
  std::filesystem::path out;
  SimulatedRunConfig run;
  std::string robot{"free"};
  std::string robot_command;   ///< a program that moves a robot; empty: robot
  std::string camera_command;  ///< a program that has a camera; empty: a simulated one
  double process_timeout_s{60.0};
  bool step{false};
  bool resume{false};
  bool write_pictures{true};
  bool force{false};

  // As they were given, before they are checked together.
  std::string strategy{"sphere"};
  double radius_m{0.8};
  CameraOptions camera;
};

/// Adds the options to the command.
void add_explore_options(CLI::App& command, ExploreOptions& options);
/// After parsing: fills `run`, and throws a usage error for what makes no sense.
void check_explore_options(ExploreOptions& options, const GlobalOptions& global);

}  // namespace saccade::cli
