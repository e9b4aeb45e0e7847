// SPDX-License-Identifier: Apache-2.0
#include "cell_options.hpp"

#include <utility>

#include "interrupt.hpp"
#include "saccade/scene/scene_yaml.hpp"

namespace saccade::cli {
namespace {

void take(std::string& option, const std::string& of_cell) {
  if (option.empty()) option = of_cell;
}

template <class T>
void take(std::optional<T>& option, const std::optional<T>& of_cell) {
  if (!option) option = of_cell;
}

void take_arm(ExploreOptions& options, const CellArm& arm) {
  options.robot = arm.robot;
  UrdfConfig& urdf = options.arm_reading.urdf;
  take(urdf.base, arm.base);
  take(urdf.tip, arm.tip);
  take(urdf.camera, arm.camera_frame);
  take(urdf.T_world_base, arm.T_world_base);
  take(urdf.T_flange_camera, arm.T_flange_camera);
  urdf.packages.insert(arm.packages.begin(), arm.packages.end());
  urdf.package_paths.insert(urdf.package_paths.end(), arm.package_paths.begin(), arm.package_paths.end());
  options.arm_reading.drop_beyond_tip = options.arm_reading.drop_beyond_tip || arm.drop_beyond_tip;
  take(options.speed, std::optional{arm.speed});
}

}  // namespace

void take_cell(ExploreOptions& options) {
  if (!std::filesystem::is_regular_file(options.scene) || is_mesh_file(options.scene)) return;
  auto read = read_cell(options.scene);
  if (!read) {
    options.cell_problem = read.error();
    return;
  }
  options.cell = *std::move(read);
  const Cell& cell = options.cell;
  take(options.camera_command, cell.camera.command);
  const bool own_robot = !options.robot.empty() || !options.robot_command.empty();
  if (!own_robot) {
    take(options.robot_command, cell.robot.command);
    if (cell.arm) take_arm(options, *cell.arm);
    take(options.joints_command, cell.joints.command);
  }
  const auto tracking = kTrackingModeNames.find(cell.tracking);
  if (!options.tracking && tracking) options.tracking = *tracking;
  options.arm.obstacles.fixtures.insert(options.arm.obstacles.fixtures.end(), cell.fixtures.begin(),
                                        cell.fixtures.end());
}

ProgramConfig program_config(const ExploreOptions& options, const std::string& command, const CellProgram& of_cell) {
  ProgramConfig config{command, {}, options.process_timeout_s, options.process_timeout_s, interrupted};
  if (command != of_cell.command) return config;
  config.folder = options.cell.folder;
  config.timeout_s = of_cell.timeout_s.value_or(config.timeout_s);
  return config;
}

ProgramJointsConfig joints_config(const ExploreOptions& options, const ArmModel& arm) {
  ProgramJointsConfig config;
  config.program = program_config(options, options.joints_command, options.cell.joints);
  config.lower = config.upper = config.speed = config.acceleration = Configuration::Zero(arm.dof());
  for (Eigen::Index i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joints()[static_cast<std::size_t>(i)];
    config.names.push_back(joint.name);
    config.lower[i] = joint.limits.lower;
    config.upper[i] = joint.limits.upper;
    config.speed[i] = joint.limits.speed;
    config.acceleration[i] = joint.limits.acceleration;
  }
  const CellWatch& watch = options.cell.watch;
  config.tolerance = watch.tolerance.value_or(config.tolerance);
  config.lag_s = watch.lag_s.value_or(config.lag_s);
  config.watchdog_s = watch.watchdog_s.value_or(config.watchdog_s);
  return config;
}

}  // namespace saccade::cli
