// SPDX-License-Identifier: Apache-2.0
#include "robot_options.hpp"

#include <CLI/CLI.hpp>

#include "add_value.hpp"
#include "options.hpp"

namespace saccade::cli {
namespace {

/// "NAME=FOLDER".
void add_package(const std::string& text, UrdfConfig& config) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    usage_error("--package", "wants NAME=FOLDER, not " + text);
  config.packages[text.substr(0, equals)] = text.substr(equals + 1);
}

}  // namespace

CLI::Option* add_arm_options(CLI::App& command, ArmOptions& options) {
  CLI::Option* robot = add_value(command, "robot", options.robot, "URDF",
                                 "a URDF file, or the name of a built-in robot (comau_smart_six, ur_like)");
  add_value(command, "--base", options.urdf.base, "LINK", "link that the chain begins with; default: the root");
  add_value(command, "--tip", options.urdf.tip, "LINK", "flange; default: the end of the longest chain");
  add_value(command, "--camera-frame", options.urdf.camera, "LINK",
            "the camera's optical frame; default: camera_optical_frame if there is one, else the tip");
  add_value(command, "--package", options.packages, "NAME=FOLDER", "where package://NAME/… lies; may be repeated");
  command.add_flag("--drop-beyond-tip", options.drop_beyond_tip, "leave out what is fixed behind the tip");
  return robot;
}

void check_arm_options(ArmOptions& options) {
  for (const std::string& package : options.packages) add_package(package, options.urdf);
  options.urdf.keep_beyond_tip = !options.drop_beyond_tip;
}

}  // namespace saccade::cli
