// SPDX-License-Identifier: Apache-2.0
#include "explore_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "add_value.hpp"
#include "cell_options.hpp"
#include "explore_surfels.hpp"
#include "length_options.hpp"
#include "robot_options.hpp"

namespace saccade::cli {
namespace {

/// "attention: views of …; standard: …"
std::string strategy_help(const Planners& planners) {
  return joined(planners.all(), "; ", [](const NamedPlanner& planner) {
    return planner.name + (planner.text.empty() ? "" : ": " + planner.text);
  });
}

}  // namespace

void add_arm_options(CLI::App& command, ExploreOptions& options) {
  add_reading_options(command, options.arm_reading);
  add_value(command, "--speed", options.speed, "SHARE", "share of the speeds that the arm's URDF allows");
  add_value(
      command, "--joints-command", options.joints_command, "COMMAND",
      "a program that moves the arm's joints along trajectories that are planned here (docs/guides/processes.md)");
  add_value(command, "--fixture", options.fixtures, "X0,Y0,Z0,X1,Y1,Z1",
            "a solid box that the arm keeps clear of, besides those of the scene; may be repeated");
  add_value(command, "--free", options.free, "X0,Y0,Z0,X1,Y1,Z1",
            "a box that is known to be empty at the beginning; may be repeated. The volume that the arm sweeps in its "
            "initial scan counts as empty anyway");
  add_value(command, "--obstacle-cell", options.arm.obstacles.cell_size_m, "METRES",
            "edge of the cells in which the arm plans, metres; a cell is an obstacle if any voxel in it is");
  command.add_flag("--unknown-is-free{false}", options.arm.obstacles.unknown_is_obstacle,
                   "let the arm move through space that was never seen");
  static const std::vector<std::string> planners = planner_names();  // the words outlive the parsing
  const auto take = [&options](const std::string& name) { options.arm.planner.planner = name; };
  add_words(command, "--planner", std::vector<std::string_view>{planners.begin(), planners.end()}, take,
            "planner of paths, by OMPL's name", options.arm.planner.planner);
}

void check_arm_options(ExploreOptions& options, const GlobalOptions& global) {
  check_arm_options(options.arm_reading);
  if (!options.has_arm()) require_no_reading(options.arm_reading);
  for (const std::string& text : options.fixtures) {
    options.arm.obstacles.fixtures.push_back(parse_box("--fixture", text));
    require_near(options.arm.obstacles.fixtures.back(), "--fixture");
  }
  options.arm.planner.seed = global.seed;
  options.arm.ik.numeric.restarts = kNumericRestarts;
  if (!options.has_arm() && !options.joints_command.empty())
    usage_error("--joints-command", "needs an arm that plans: give --robot, a URDF");
  if (options.speed && !(*options.speed > 0.0 && *options.speed <= 1.0))
    usage_error("--speed", "is a share of the arm's own speed: above 0, at most 1");
  require_length(options.arm.obstacles.cell_size_m, "--obstacle-cell");
  require_ok(options.arm.validate(), "--obstacle-cell, --fixture");
  for (const Box& box : options.free_boxes()) require_near(box, "--free");
}

std::vector<Box> ExploreOptions::free_boxes() const {
  std::vector<Box> boxes = cell.free;
  for (const std::string& text : free) boxes.push_back(parse_box("--free", text));
  return boxes;
}

void add_device_options(CLI::App& command, ExploreOptions& options) {
  add_value(command, "--robot", options.robot, "ROBOT",
            "carrier of the camera: comau, a URDF file, or free, which flies; comau by default, but free with "
            "--camera-command");
  add_value(command, "--robot-command", options.robot_command, "COMMAND",
            "a program that moves a robot, which plans for itself (docs/guides/processes.md)")
      ->excludes("--robot");
  add_value(
      command, "--camera-command", options.camera_command, "COMMAND",
      "a program that has a depth camera (docs/guides/processes.md); then there is no ground truth to compare with");
  add_value(command, "--process-timeout", options.process_timeout_s, "SECONDS",
            "seconds after which a program that does not answer is given up");
  add_choice(
      command, "--tracking", options.tracking, kTrackingModeNames,
      "source of the poses of frames: forced, the robot; hint, ICP that begins at the robot's pose, or that "
      "pose where ICP fails; icp, ICP alone, and frames where it fails are left out; rgbd, the same with colours "
      "(default: forced)");
  command.add_flag("--truth", options.with_truth,
                   "the camera's program simulates the scene's objects, as in a simulated cell; coverage is measured");
  add_value(command, "--map", options.map, "FILE", "start from a saved map (.sacmap) instead of an unknown one");
}

void add_dry_run_option(CLI::App& command, ExploreOptions& options) {
  command.add_flag("--dry-run", options.dry_run,
                   "plan and draw the scan and the first view after it, from where the robot stands, and move nothing");
}

void check_device_options(ExploreOptions& options) {
  require_positive(options.process_timeout_s, "--process-timeout");
  take_cell(options);
  options.run.exploration.camera_clock_offset_s = options.cell.camera_clock_offset_s;
  options.run.exploration.tracking = options.tracking.value_or(TrackingMode::forced);
}

void limit_dry_run(ExploreOptions& options) {
  if (!options.dry_run) return;
  options.run.exploration.max_views = std::min(options.run.exploration.max_views, 1);
  options.run.exploration.tracking = TrackingMode::forced;
  options.run.exploration.frame_on_way_s = 0.0;
}

void add_explore_options(CLI::App& command, ExploreOptions& options, const Planners& planners) {
  add_value(command, "scene", options.scene, "SCENE",
            "name of a built-in scene, clutter:SEED, a YAML file of a scene or a cell (docs/reference/cell.md), or a "
            "mesh file, which is put on a table")
      ->required();
  add_mesh_options(command, options.mesh);
  add_value(command, "--strategy", options.strategy, "NAME", strategy_help(planners));
  add_saliency_options(command, options.saliency);
  add_choice(command, "--backend", options.backend, kComputeBackendNames,
             "where gains of views and the surface that is expected are computed; views are the same");
  add_run_options(command, options, min_gain_by_strategy());
  add_foresight_options(command, options);

  add_arm_options(command, options);
  add_device_options(command, options);
  add_surfel_options(command, options);
  add_dry_run_option(command, options);
  command.add_flag("--step", options.step, "ask before each move");
  command.add_flag("--resume", options.resume, "go on with the interrupted run in RUN");
  command.add_flag("--no-pictures{false}", options.write_pictures,
                   "draw no pictures, write no report, and keep no maps of views");
  command.add_flag("--show", options.show, "show the run in the browser while it goes on, and after it until Ctrl-C");
  add_serve_options(command, options.serve);
  add_message_options(command, options.messages);
}

void check_explore_options(const CLI::App& command, ExploreOptions& options, const GlobalOptions& global) {
  check_surfel_options(command, options);
  if (options.resume && options.force) usage_error("--resume", "goes on with a run, --force starts it anew: not both");
  if (!options.show && !options.serve.given.empty()) usage_error(options.serve.given, "is for --show");
  require_ok(options.mesh.validate(), "--mesh-scale");
  check_device_options(options);
  check_run_options(options);
  // No surface is expected of an empty bench: what is unknown is looked at instead.
  const bool rehearses = options.dry_run && options.map.empty() && options.strategy == surface_planner().name;
  const Result<NamedPlanner> strategy =
      options.surfels ? surfel_planner(options.surfels) : global.planners.find(rehearses ? "sphere" : options.strategy);
  require_ok(strategy.ok() ? Status{} : Status{strategy.error()}, "--strategy");
  choose_strategy(options, *strategy);
  if (strategy->needs_truth && !options.camera_command.empty()) {
    usage_error("--strategy", strategy->name + " knows the true scene, which there is not with --camera-command");
  }
  check_saliency_options(options.saliency, false);
  options.run.attention.saliency = options.saliency.heuristic;
  options.run.weigh_by_saliency = options.saliency.given && options.saliency.names != "none";
  options.run.seed = global.seed;
  if (options.robot.empty()) options.robot = options.camera_command.empty() ? "comau" : "free";
  check_foresight(options, options.robot);
  check_arm_options(options, global);
  if (options.dry_run && (options.resume || options.step))
    usage_error("--dry-run", "moves nothing: it goes with neither --resume nor --step");
  limit_dry_run(options);
}

}  // namespace saccade::cli
