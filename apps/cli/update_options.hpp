// SPDX-License-Identifier: Apache-2.0
#pragma once
// UpdateOptions: what `saccade update` is told.

#include "attend_methods.hpp"
#include "explore_options.hpp"
#include "saccade/explore/environment_update.hpp"
#include "saccade/io/frames/trajectory_io.hpp"

namespace saccade::cli {

/// Has the exploration's options of the camera, the robot and the run; `scene` is the one after the task.
struct UpdateOptions : ExploreOptions {
  UpdateOptions();

  std::string cell_file;                ///< a real cell; empty: a simulated scene
  std::string hand_command;             ///< program that tracks the hand of a cell
  std::string before;                   ///< scene before the task; empty: SCENE-before
  std::string trajectory{"simulated"};  ///< a file, or "simulated"
  HandFileOptions hand_file;
  const AttendMethod* method{nullptr};  ///< nullptr before the check: ours, or the thesis' with --as-printed
  double region_radius_m{0.2};
  FuseWhen fuse_when{FuseWhen::viewpoints};

  [[nodiscard]] bool simulates_hand() const { return trajectory == "simulated"; }
};

/// Adds the options to the command.
void add_update_options(CLI::App& command, UpdateOptions& options);
/// After parsing: fills `run` and `arm`, and throws a usage error for what makes no sense.
void check_update_options(UpdateOptions& options, const GlobalOptions& global);

}  // namespace saccade::cli
