// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExploreOptions: what `saccade explore` is told.

#include <filesystem>
#include <memory>
#include <string>

#include "command.hpp"
#include "run_options.hpp"

namespace saccade::cli {

struct ExploreOptions : RunOptions {
  std::string scene;
  std::filesystem::path out;
  std::string robot{"free"};
  std::string robot_command;   ///< a program that moves a robot; empty: robot
  std::string camera_command;  ///< a program that has a camera; empty: a simulated one
  double process_timeout_s{60.0};
  bool step{false};
  bool resume{false};
  bool write_pictures{true};
  bool force{false};
  std::string strategy{"sphere"};  ///< as it was given
};

/// Adds the options to the command.
void add_explore_options(CLI::App& command, ExploreOptions& options);
/// After parsing: fills `run`, and throws a usage error for what makes no sense.
void check_explore_options(ExploreOptions& options, const GlobalOptions& global);

}  // namespace saccade::cli
