// SPDX-License-Identifier: Apache-2.0
#include "robot_options.hpp"

#include <CLI/CLI.hpp>

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
  CLI::Option* robot =
      command.add_option("robot", options.robot, "a URDF file, or the name of a built-in robot (comau_smart_six)")
          ->type_name("URDF");
  command.add_option("--base", options.urdf.base, "link that the chain begins with; default: the root")
      ->type_name("LINK");
  command.add_option("--tip", options.urdf.tip, "flange; default: the end of the longest chain")->type_name("LINK");
  command
      .add_option("--camera-frame", options.urdf.camera,
                  "the camera's optical frame; default: camera_optical_frame if there is one, else the tip")
      ->type_name("LINK");
  command.add_option("--package", options.packages, "where package://NAME/… lies; may be repeated")
      ->type_name("NAME=FOLDER");
  command.add_flag("--drop-beyond-tip", options.drop_beyond_tip, "leave out what is fixed behind the tip");
  return robot;
}

void check_arm_options(ArmOptions& options) {
  for (const std::string& package : options.packages) add_package(package, options.urdf);
  options.urdf.keep_beyond_tip = !options.drop_beyond_tip;
}

}  // namespace saccade::cli
