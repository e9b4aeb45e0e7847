// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExploreOptions: what `saccade explore` is told.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "command.hpp"
#include "compute_backend.hpp"
#include "message_options.hpp"
#include "robot_options.hpp"
#include "run_options.hpp"
#include "saccade/devices/cell.hpp"
#include "segment_saliency.hpp"
#include "serve.hpp"

namespace saccade::cli {

struct ExploreOptions : RunOptions {
  std::string scene;
  MeshSceneConfig mesh;  ///< how a mesh file becomes a scene
  std::filesystem::path out;
  ArmOptions arm_reading;  ///< its robot is not used
  std::string robot;       ///< a built-in arm, a URDF, or free; empty: an arm, or free with a camera of one's own
  std::vector<std::string> fixtures;  ///< as they were given
  std::vector<std::string> free;      ///< boxes, too
  PlannedArmConfig arm;
  std::string joints_command;              ///< a program that moves the arm's joints; empty: they are simulated
  std::optional<double> speed{};           ///< share of the arm's speeds; nullopt: all of them
  std::optional<TrackingMode> tracking{};  ///< nullopt: forced
  std::filesystem::path map;               ///< saved map to go on from; empty: nothing is known
  std::shared_ptr<SurfelModel> surfels{};  ///< --map surfels; nullptr: the map is a volume
  Cell cell;                               ///< that the scene's file describes
  std::optional<Error> cell_problem{};     ///< what is wrong with that file
  std::string robot_command;               ///< a program that moves a robot; empty: robot
  std::string camera_command;              ///< a program that has a camera; empty: a simulated one
  double process_timeout_s{60.0};
  bool dry_run{false};  ///< plans and draws, and moves nothing
  bool step{false};
  bool resume{false};
  bool write_pictures{true};
  bool force{false};
  std::string strategy{"surface"};  ///< as it was given
  SaliencyOptions saliency;
  ComputeBackend backend{ComputeBackend::cpu};

  MessageOptions messages;

  bool show{false};
  ServeOptions serve;

  /// Whether the run keeps the candidates of each view and the map after it, for saccade show.
  [[nodiscard]] bool keeps_views() const { return write_pictures || show; }
  [[nodiscard]] bool has_arm() const { return robot_command.empty() && robot != "free"; }
  bool with_truth{false};  ///< the scene's objects are what a program's camera sees
  /// Whether the scene is what the camera sees.
  [[nodiscard]] bool knows_truth() const { return camera_command.empty() || with_truth; }
  /// A real robot or arm, which is not where a simulated one would be.
  [[nodiscard]] bool moves_real() const { return !robot_command.empty() || !joints_command.empty(); }
  /// Whether programs see or move; what they did cannot be computed again.
  [[nodiscard]] bool has_programs() const { return moves_real() || !camera_command.empty(); }
  /// Boxes that are known to be free from the beginning.
  [[nodiscard]] std::vector<Box> free_boxes() const;
};

/// Adds what add_reading_options does, --speed, --joints-command, --fixture, --free, --obstacle-cell, --unknown-is-free
/// and --planner.
void add_arm_options(CLI::App& command, ExploreOptions& options);
/// After parsing: fills `arm`. Throws a usage error for what makes no sense.
void check_arm_options(ExploreOptions& options, const GlobalOptions& global);

/// Adds --robot, --camera-command, --robot-command, --process-timeout, --tracking and --map.
void add_device_options(CLI::App& command, ExploreOptions& options);
/// After parsing: takes the cell's file in, fills `run.exploration.tracking`, and throws a usage error for what makes
/// no sense.
void check_device_options(ExploreOptions& options);
/// Adds --dry-run.
void add_dry_run_option(CLI::App& command, ExploreOptions& options);
/// Once all else is checked: a dry run plans the first view alone.
void limit_dry_run(ExploreOptions& options);

/// Adds the options to the command.
void add_explore_options(CLI::App& command, ExploreOptions& options, const Planners& planners);
/// After parsing: fills `run`, and throws a usage error for what makes no sense.
void check_explore_options(const CLI::App& command, ExploreOptions& options, const GlobalOptions& global);

}  // namespace saccade::cli
