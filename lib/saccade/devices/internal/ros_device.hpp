// SPDX-License-Identifier: Apache-2.0
#pragma once
// Devices over ROS, "ros:/camera/depth" or "ros2:/camera/depth". RosOptions: the options that a cell's file may give.
// ros_command_line: the program behind a device.

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "saccade/core/result.hpp"
#include "saccade/devices/programs.hpp"

namespace saccade {

/// Returns the keys that a cell's file may have beside the name, which are options of the program: "info" is --info; a
/// key has _ instead of -.
[[nodiscard]] std::span<const std::string_view> ros_options(std::string_view role);

/// Tells whether a command names a device over ROS.
[[nodiscard]] bool is_over_ros(std::string_view command);

/// Answers invalid_argument for a role that no program over ROS has, or an invalid topic name.
[[nodiscard]] Status check_over_ros(std::string_view role, std::string_view command);

/// Returns the path of a version's program, quoted for a shell. Answers unavailable when it is missing.
[[nodiscard]] Result<std::string> quoted_program(const RosProgram& version, const std::string& context);

/// Quotes a text for a shell, where needed.
[[nodiscard]] std::string shell_quoted(std::string_view text);

/// Returns the command for a shell: unchanged, if it is not over ROS. Answers unavailable when Saccade was built
/// without ROS.
[[nodiscard]] Result<std::string> ros_command_line(std::string_view role, const std::string& command);

}  // namespace saccade
