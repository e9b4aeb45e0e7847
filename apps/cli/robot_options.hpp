// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmOptions: which arm, and how its description is read, as the command line says it.

#include <memory>
#include <string>
#include <vector>

#include "progress_bar.hpp"
#include "saccade/arm/urdf.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace saccade::cli {

/// Ten times fewer than elsewhere: most poses that are tried cannot be reached, and every one of those takes all of
/// them.
constexpr int kNumericRestarts{10};

struct ArmOptions {
  std::string robot;  ///< a built-in arm or a URDF file, where a command has this as its subject
  UrdfConfig urdf{};
  std::vector<std::string> packages{};
  std::vector<std::string> package_paths{};
  bool drop_beyond_tip{false};
  std::string given{};  ///< the first of the options that was given; empty: none
};

/// Adds --base, --base-at, --tip, --camera-frame, --package, --package-path, --drop-beyond-tip: how the description of
/// an arm is read.
void add_reading_options(CLI::App& command, ArmOptions& options);
/// Adds the robot and these. Returns the option of the robot.
CLI::Option* add_arm_options(CLI::App& command, ArmOptions& options);
/// After parsing: fills `urdf`; throws a usage error for what makes no sense.
void check_arm_options(ArmOptions& options);
/// Throws a usage error where one of the options was given although no arm carries the camera.
void require_no_reading(const ArmOptions& options);
/// Shows what had to be chosen, as neither the description nor an option says it.
void show_choices(const UrdfArm& read, ProgressBar& bar);

}  // namespace saccade::cli
