// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmOptions: which arm, and how its description is read, as the command line says it.

#include <memory>
#include <string>
#include <vector>

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
  std::string robot;
  UrdfConfig urdf;
  std::vector<std::string> packages;
  bool drop_beyond_tip{false};
};

/// Adds the robot and --base, --tip, --camera-frame, --package, --drop-beyond-tip. Returns the option of the robot.
CLI::Option* add_arm_options(CLI::App& command, ArmOptions& options);
/// After parsing: fills `urdf`; throws a usage error for what makes no sense.
void check_arm_options(ArmOptions& options);

}  // namespace saccade::cli
