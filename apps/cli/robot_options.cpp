// SPDX-License-Identifier: Apache-2.0
#include "robot_options.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <sstream>

#include "add_value.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "saccade/core/angle.hpp"

namespace saccade::cli {
namespace {

/// "NAME=FOLDER".
void add_package(const std::string& text, UrdfConfig& config) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    usage_error("--package", "wants NAME=FOLDER, not " + text);
  config.packages[text.substr(0, equals)] = text.substr(equals + 1);
}

/// "DIR[:DIR]".
void add_package_paths(const std::string& text, UrdfConfig& config) {
  std::istringstream parts{text};
  for (std::string folder; std::getline(parts, folder, ':');) {
    if (folder.empty()) continue;
    if (!std::filesystem::is_directory(folder)) usage_error("--package-path", "there is no folder " + folder);
    config.package_paths.emplace_back(folder);
  }
}

Pose parse_base(const std::string& text) {
  const std::vector<double> n = parse_numbers("--base-at", text, 0);
  if (n.size() != 3 && n.size() != 4) usage_error("--base-at", "needs X,Y,Z or X,Y,Z,DEGREES, not '" + text + "'");
  const double turn_rad = n.size() == 4 ? to_rad(n[3]) : 0.0;
  return Eigen::Translation3d{n[0], n[1], n[2]} * Eigen::AngleAxisd{turn_rad, Eigen::Vector3d::UnitZ()};
}

}  // namespace

void add_reading_options(CLI::App& command, ArmOptions& options) {
  const auto note = [&options](CLI::Option* option) {
    option->each([&options, option](const std::string&) {
      if (options.given.empty()) options.given = option->get_name();
    });
  };
  note(add_value(command, "--base", options.urdf.base, "LINK", "link that the arm begins with; default: the root"));
  note(command
           .add_option_function<std::string>(
               "--base-at", [&options](const std::string& text) { options.urdf.T_world_base = parse_base(text); },
               "where the arm's first link (--base) stands, turned about z by DEGREES (default: as the URDF says)")
           ->type_name("X,Y,Z[,DEGREES]"));
  note(add_value(command, "--tip", options.urdf.tip, "LINK",
                 "flange; default: the link behind the camera's last joint, else the end of the longest chain"));
  note(add_value(command, "--camera-frame", options.urdf.camera, "LINK",
                 "the camera's optical frame; default: camera_optical_frame, else a link at the flange that ends in "
                 "optical_frame, else the tip"));
  note(
      add_value(command, "--package", options.packages, "NAME=FOLDER", "where package://NAME/… lies; may be repeated"));
  note(
      add_value(command, "--package-path", options.package_paths, "DIR[:DIR]",
                "folders that hold packages, searched where --package and the URDF's own folders have none; then those "
                "of ROS_PACKAGE_PATH; may be repeated"));
  command.add_flag("--drop-beyond-tip", options.drop_beyond_tip, "ignore everything that is fixed behind the tip");
}

CLI::Option* add_arm_options(CLI::App& command, ArmOptions& options) {
  CLI::Option* robot = add_value(command, "robot", options.robot, "URDF",
                                 "a URDF file, or the name of a built-in robot (comau_smart_six, ur_like)");
  add_reading_options(command, options);
  return robot;
}

void check_arm_options(ArmOptions& options) {
  for (const std::string& package : options.packages) add_package(package, options.urdf);
  for (const std::string& paths : options.package_paths) add_package_paths(paths, options.urdf);
  options.urdf.keep_beyond_tip = !options.drop_beyond_tip;
  options.urdf.cancelled = interrupted;
}

void require_no_reading(const ArmOptions& options) {
  const std::string given = options.given.empty() && options.drop_beyond_tip ? "--drop-beyond-tip" : options.given;
  if (!given.empty()) usage_error(given, "is for an arm, and none carries the camera");
}

void show_choices(const UrdfArm& read, ProgressBar& bar) {
  for (const std::string& choice : read.choices) bar.note("arm: " + choice);
}

}  // namespace saccade::cli
