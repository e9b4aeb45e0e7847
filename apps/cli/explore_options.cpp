// SPDX-License-Identifier: Apache-2.0
#include "explore_options.hpp"

#include <CLI/CLI.hpp>
#include <set>

namespace saccade::cli {

void add_explore_options(CLI::App& command, ExploreOptions& options) {
  command.add_option("scene", options.scene, "name of a built-in scene, clutter:SEED, or a YAML file")
      ->required()
      ->type_name("SCENE");
  command.add_option("--out", options.out, "folder for the results; made if it is not there")
      ->required()
      ->type_name("RUN");
  command
      .add_option("--strategy", options.strategy,
                  "sphere: best gain on the view sphere around each region; random: its poses in random order")
      ->check(CLI::IsMember(std::set<std::string>{"sphere", "random"}))
      ->capture_default_str();
  add_run_options(command, options);

  command.add_option("--robot", options.robot, "what carries the camera; free: it flies")
      ->check(CLI::IsMember(std::set<std::string>{"free"}))
      ->capture_default_str();
  command.add_option("--robot-command", options.robot_command, "a program that moves a robot (docs/processes.md)")
      ->type_name("COMMAND")
      ->excludes("--robot");
  command
      .add_option("--camera-command", options.camera_command,
                  "a program that has a depth camera (docs/processes.md); there is no truth to compare with then")
      ->type_name("COMMAND");
  command
      .add_option("--process-timeout", options.process_timeout_s,
                  "seconds after which such a program that does not answer is given up")
      ->type_name("SECONDS")
      ->capture_default_str();
  command.add_flag("--step", options.step, "ask before each move");
  command.add_flag("--resume", options.resume, "go on with the interrupted run in RUN");
  command.add_flag("--no-pictures{false}", options.write_pictures, "draw no pictures, and write no report");
  command.add_flag("--force", options.force, "write into a folder that holds other files or an interrupted run");
}

void check_explore_options(ExploreOptions& options, const GlobalOptions& global) {
  if (options.resume && options.force) usage_error("--resume", "goes on with a run, --force starts it anew: not both");
  require_positive(options.process_timeout_s, "--process-timeout");
  check_run_options(options);
  const auto strategy = strategy_kind(options.strategy);
  require_ok(strategy.ok() ? Status{} : Status{strategy.error()}, "--strategy");
  options.run.strategy = *strategy;
  options.run.seed = global.seed;
}

}  // namespace saccade::cli
