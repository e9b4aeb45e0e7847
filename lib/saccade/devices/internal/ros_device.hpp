// SPDX-License-Identifier: Apache-2.0
#pragma once
// Devices over ROS, "ros:/camera/depth" or "ros2:/camera/depth": RosOptions, what a cell's file may say of one;
// ros_command_line, the program behind it.

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "saccade/core/result.hpp"
#include "saccade/devices/programs.hpp"

namespace saccade {

/// Returns the keys that a cell's file may have beside the name, which are options of the program: "info" is --info; a
/// key has _ in place of -.
[[nodiscard]] std::span<const std::string_view> ros_options(std::string_view role);

/// Whether a command names a device over ROS.
[[nodiscard]] bool is_over_ros(std::string_view command);

/// invalid_argument for a role that no program over ROS has, or a name that no topic can have.
[[nodiscard]] Status check_over_ros(std::string_view role, std::string_view command);

/// Returns the path of a version's program, for a shell. unavailable: it is not there.
[[nodiscard]] Result<std::string> quoted_program(const RosProgram& version, const std::string& context);

/// Quotes a text for a shell, where it needs to be.
[[nodiscard]] std::string shell_quoted(std::string_view text);

/// Returns the command as a shell runs it: itself, if it is not over ROS. unavailable: Saccade was built without.
[[nodiscard]] Result<std::string> ros_command_line(std::string_view role, const std::string& command);

}  // namespace saccade
