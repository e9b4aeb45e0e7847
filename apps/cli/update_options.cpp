// SPDX-License-Identifier: Apache-2.0
#include "update_options.hpp"

#include <CLI/CLI.hpp>

#include "add_value.hpp"
#include "explore_surfels.hpp"
#include "length_options.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

void add_hand_options(CLI::App& command, UpdateOptions& options) {
  add_value(
      command, "--trajectory", options.trajectory, "FILE|simulated",
      "how the hand moved in the task: a file (docs/reference/formats.md) or a bag of ROS, in the scene's frame, or "
      "simulated");
  add_hand_file_options(command, options.hand_file);
  add_method_option(command, options.method);
  options.method = nullptr;  // unless it is named: check_update_options chooses
  add_value(command, "--region-radius", options.region_radius_m, "METRES",
            "radius of what is forgotten around each action of the hand, metres");
}

/// Applies --as-printed to what was not named: GMM-AS by the values that give the thesis' own tables, and a virtual
/// sensor with all pixels of the camera. IncTh stays the same share of its rays.
void follow_the_thesis(UpdateOptions& options) {
  if (options.method == nullptr) options.method = find_attend_method("gmm-as");
  const int usual_px = options.run.gain_width_px;
  if (options.gain_width_px) return;
  options.run.gain_width_px = options.run.camera.width;
  const double scale = static_cast<double>(options.run.gain_width_px) / usual_px;
  options.run.planner.min_gain *= scale * scale;
}

/// A cell, or a simulated scene with a simulated camera.
void check_subject(UpdateOptions& options) {
  if (options.cell_file.empty() == options.scene.empty()) usage_error("CELL", "is needed, or --scene: one of them");
  if (options.cell_file.empty()) {
    if (!options.camera_command.empty()) usage_error("--camera-command", "is for a cell");
    if (options.moves_real()) usage_error("--joints-command, --robot-command", "are for a cell");
    if (!options.hand_command.empty()) usage_error("--hand-command", "is for a cell");
    if (!options.map.empty()) usage_error("--map", "is for a cell");
    if (options.robot.empty()) options.robot = "comau";
    options.run.exploration.tracking = options.tracking.value_or(TrackingMode::forced);
    return;
  }
  options.scene = options.cell_file;
  if (options.map == kSurfelsWord)
    usage_error("--map",
                "an update forgets what has changed, and surfels are never removed; give a saved map (.sacmap)");
  check_device_options(options);
  if (options.hand_command.empty()) options.hand_command = options.cell.hand.command;
  if (options.robot.empty()) options.robot = options.camera_command.empty() ? "comau" : "free";
}

}  // namespace

UpdateOptions::UpdateOptions() {
  run.strategy = builtin_planners().find("sphere").value();
  run.exploration.max_views = kUpdateMaxViews;
  run.planner.min_gain = kUpdateMinGain;
}

void add_update_options(CLI::App& command, UpdateOptions& options) {
  add_value(command, "cell", options.cell_file, "CELL",
            "a cell's YAML file (docs/reference/cell.md): its hand's tasks are waited for; without it, the task is "
            "simulated");
  add_value(command, "--scene", options.scene, "SCENE",
            "the scene after a simulated task: bottle, jug, another built-in one, a YAML file or a mesh file");
  add_value(command, "--before", options.before, "SCENE", "the scene before the task (default: SCENE-before)");
  add_hand_options(command, options);
  add_choice(command, "--fuse-when", options.fuse_when, kFuseWhenNames,
             "when the camera's frames are fused: at viewpoints alone (the thesis' KFOVP), or also in motion, which is "
             "slower then (KFOM)");
  add_run_options(command, options, fixed(kUpdateMinGain, 0));
  add_device_options(command, options);
  add_value(command, "--hand-command", options.hand_command, "COMMAND",
            "with CELL: a program that tracks the hand (docs/guides/processes.md)");
  add_arm_options(command, options);
  add_dry_run_option(command, options);
  command.add_flag(
      "--resume", options.resume,
      "with CELL: go on with the interrupted updates in the folder: with their map and tasks, and first with "
      "the regions that were left");
  add_message_options(command, options.messages);
  command.add_flag("--no-pictures{false}", options.write_pictures, "draw no pictures, and write no report");
}

void check_update_options(UpdateOptions& options, const GlobalOptions& global) {
  check_subject(options);
  check_run_options(options);
  if (options.run.as_printed) follow_the_thesis(options);
  if (options.method == nullptr) options.method = &attend_methods().front();
  if (options.min_gain) options.run.planner.min_gain = *options.min_gain;
  require_ok(options.run.planner.validate(), "--min-gain");
  check_arm_options(options, global);
  require_length(options.region_radius_m, "--region-radius");
  options.run.seed = global.seed;
  if (options.fuse_when == FuseWhen::motion) {
    if (!options.has_arm())
      usage_error("--fuse-when", "a camera that flies is at the next view at once; motion needs an arm");
    options.run.exploration.frame_on_way_s = kFrameOnWay_s;
    options.run.exploration.way_counts = false;  // views are those of the thesis, whenever frames are fused
  }
  limit_dry_run(options);
  if (options.resume && (options.force || options.dry_run || !options.map.empty()))
    usage_error("--resume", "goes on with what is in the folder: it goes with none of --force, --dry-run and --map");
  if (!options.cell_file.empty()) return;
  if (options.dry_run) usage_error("--dry-run", "is for a CELL: a simulated task moves nothing that is real");
  if (options.resume) usage_error("--resume", "is for a CELL");
  const bool is_file = std::filesystem::path{options.scene}.has_extension();
  if (options.before.empty() && is_file) usage_error("--before", "is needed where --scene is a file");
  if (options.before.empty()) options.before = options.scene + "-before";
}

}  // namespace saccade::cli
